// [Gross1999, figures 3.3 and 3.12]: the eigenforms of the linear double pendulum are drawn; their numbers are
// equations 3.64, 3.65, 3.67, 3.69, 3.73 to 3.76 in absolute and 3.99 to 3.110 in relative angles. M and C are the
// library's.
#include <fmt/format.h>

#include <array>
#include <cmath>

#include "../experiment.hpp"
#include "hamflow/problems/double_pendulum_linear_absolute.hpp"
#include "hamflow/problems/double_pendulum_linear_relative.hpp"

namespace hamflow::reproduction {

namespace eigenforms {

using Pair = Vector<double, 2>;
using Square = Matrix<double, 2>;
const double root = std::sqrt(13.0);
constexpr double g = 9.81;
constexpr double l = 0.5;

struct Printed {
  const char* vectors;
  const char* page_of_vectors;
  const char* amplitudes;
  const char* page_of_amplitudes;
  std::array<Pair, 2> forms;  // as printed
  std::array<Pair, 2> A;      // rows of q0 -> A1, A2
  std::array<Pair, 2> B;      // rows of q'0 -> B1, B2
};

Pair scaled(double factor, double a, double b) { return {factor * a, factor * b}; }
Pair applied(const Square& m, const Pair& x) {
  return {m[0][0] * x[0] + m[0][1] * x[1], m[1][0] * x[0] + m[1][1] * x[1]};
}
double largest(const Pair& x) { return std::max(std::abs(x[0]), std::abs(x[1])); }

Printed absolute_angles() {
  return {"3.67, 3.69",
          "87",
          "3.73 to 3.76",
          "87",
          {Pair{(1 - root) / 6, 1}, Pair{(1 + root) / 6, 1}},
          {scaled((13 + root) / 52, 1 - root, 2), scaled((13 - root) / 52, 1 + root, 2)},
          {scaled((13 - 3 * root) * std::sqrt(g * l * (4 + root)) / (52 * g), 1 - root, 2),
           scaled((13 + 3 * root) * std::sqrt(g * l * (4 - root)) / (52 * g), 1 + root, 2)}};
}
Printed relative_angles() {
  return {"3.101, 3.103",
          "97",
          "3.107 to 3.110",
          "98",
          {Pair{1, -(3 + root) / 2}, Pair{1, -(3 - root) / 2}},
          {scaled((13 - 3 * root) / 52, 2, -3 - root), scaled((13 + 3 * root) / 52, 2, -3 + root)},
          {scaled((13 - 4 * root) * std::sqrt(g * l * (4 + root)) / (78 * g), 3 - root, 2),
           scaled((13 + 4 * root) * std::sqrt(g * l * (4 - root)) / (78 * g), 3 + root, 2)}};
}

void carry_out(Study& study, const Square& mass, const Square& stiffness, const Printed& printed) {
  study.nothing_to_test("drawing", "a drawing: it shows no number and no curve");
  const std::array<double, 2> omega{std::sqrt((4 + root) * g / l), std::sqrt((4 - root) * g / l)};
  const double rounding = 32 * 0x1p-52;
  double off = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    const Pair inertia = applied(mass, printed.forms[i]), pull = applied(stiffness, printed.forms[i]);
    for (std::size_t j = 0; j < 2; ++j) {
      off = std::max(off, std::abs(pull[j] - omega[i] * omega[i] * inertia[j]) / largest(pull));
    }
  }
  study.claim(
      {"eigenvectors", fmt::format("equations {} are the eigenvectors of the linear double pendulum", printed.vectors),
       "Eigenvektoren", printed.page_of_vectors},
      at_most(rounding, "rounding of C K = w^2 M K, relative to |C K|"),
      {{off, 0, "largest component of (C - w^2 M) K over |C K|"}}, Grounds::identity);
  // An eigenform k has A_k = 1 at q0 = l_k and B_k = 1 at q'0 = w_k l_k, and all others 0: equation 3.34.
  double of_A = 0, of_B = 0;
  for (std::size_t i = 0; i < 2; ++i) {
    for (std::size_t k = 0; k < 2; ++k) {
      const double expected = i == k ? 1 : 0;
      const Pair& form = printed.forms[k];
      of_A = std::max(of_A, std::abs(printed.A[i][0] * form[0] + printed.A[i][1] * form[1] - expected));
      of_B = std::max(of_B, std::abs(omega[k] * (printed.B[i][0] * form[0] + printed.B[i][1] * form[1]) - expected));
    }
  }
  study.claim({"amplitudes", fmt::format("equations {} are the solution of equation 3.34", printed.amplitudes),
               "A1, A2, B1, B2", printed.page_of_amplitudes},
              at_most(rounding, "rounding of the amplitudes of the eigenforms, which are 1 and 0"),
              {{std::max(of_A, of_B), 0, fmt::format("largest error of A {:.2g}, of B {:.2g}", of_A, of_B)}},
              Grounds::identity);
}

}  // namespace eigenforms

std::vector<Experiment> eigenforms_experiments() {
  const Vector<double, 2> m{0.25, 0.25}, l{eigenforms::l, eigenforms::l};
  return {
      {{"G3.3", gross, "88", "eigenforms of the linear double pendulum, absolute angles"},
       [m, l](Study& study) {
         const DoublePendulumLinearAbsolute<> problem(m, l);
         eigenforms::carry_out(study, problem.mass_matrix(), problem.stiffness_matrix(), eigenforms::absolute_angles());
       }},
      {{"G3.12", gross, "99", "eigenforms of the linear double pendulum, relative angles"}, [m, l](Study& study) {
         const DoublePendulumLinearRelative<> problem(m, l);
         eigenforms::carry_out(study, problem.mass_matrix(), problem.stiffness_matrix(), eigenforms::relative_angles());
       }}};
}

}  // namespace hamflow::reproduction
