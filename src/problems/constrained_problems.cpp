#include "constrained_problems.hpp"

#include "engine/erased.hpp"
#include "generalised.hpp"
#include "hamflow/detail/problems/double_pendulum_body.hpp"
#include "hamflow/problems/pendulum.hpp"
#include "hamflow/problems/t_tube.hpp"
#include "known_exact.hpp"
#include "typed_problem.hpp"

namespace hamflow {

namespace {

/// [x, y] = l (sin q, -cos q).
template <class R>
struct Circle {
  static constexpr std::size_t dimension = 1;
  static constexpr std::size_t space = 2;
  R length;
  explicit Circle(const Parameters<R>& given) : length(given["length"]) {}
  Matrix<R, 2> mass(const Parameters<R>& given) const {
    const R m = given["mass"];
    return {Vector<R, 2>{m, R(0)}, {R(0), m}};
  }
  template <class S>
  Vector<S, 2> operator()(const Vector<S, 1>& q) const {
    return {sin(q[0]) * length, -(cos(q[0]) * length)};
  }
  static Vector<R, 1> angles(const Vector<R, 2>& x) { return {R(atan2(x[0], -x[1]))}; }
};

/// r1 = l1 (sin q1, -cos q1), r2 = 2 r1 + l2 (sin q2, -cos q2).
template <class R>
struct TwoRods {
  static constexpr std::size_t dimension = 2;
  static constexpr std::size_t space = 4;
  R first;
  R second;
  explicit TwoRods(const Parameters<R>& given)
      : first(given.list("half_lengths").at(0)), second(given.list("half_lengths").at(1)) {}
  Matrix<R, 4> mass(const Parameters<R>& given) const { return masses_of(given); }
  static Matrix<R, 4> masses_of(const Parameters<R>& given) {
    Matrix<R, 4> m{};
    for (std::size_t i = 0; i < 4; ++i) m[i][i] = given.list("masses").at(i / 2);
    return m;
  }
  template <class S>
  Vector<S, 4> operator()(const Vector<S, 2>& q) const {
    const S x = sin(q[0]) * first;
    const S y = -(cos(q[0]) * first);
    return {x, y, R(2) * x + sin(q[1]) * second, R(2) * y - cos(q[1]) * second};
  }
  static Vector<R, 2> angles(const Vector<R, 4>& x) {
    return {R(atan2(x[0], -x[1])), R(atan2(x[2] - R(2) * x[0], R(2) * x[1] - x[3]))};
  }
};

/// (Q1, Q2) on the rails y1 = 0, x2 = 0.
template <class R>
struct Rails {
  static constexpr std::size_t dimension = 2;
  static constexpr std::size_t space = 4;
  explicit Rails(const Parameters<R>&) {}
  Matrix<R, 4> mass(const Parameters<R>& given) const { return TwoRods<R>::masses_of(given); }
  template <class S>
  Vector<S, 4> operator()(const Vector<S, 2>& q) const {
    const S zero = q[0] * R(0);
    return {q[0], zero, zero, q[1]};
  }
  static Vector<R, 2> angles(const Vector<R, 4>& x) { return {x[0], x[3]}; }
};

/// Maps to the chart of generalised coordinates (mostly angles) and back.
template <template <class> class Map>
struct ChartOfAngles {
  static constexpr std::size_t k = Map<double>::dimension;
  static constexpr std::size_t n = Map<double>::space;

  template <class R>
  static Start<R, k> to_angles(const Parameters<R>& given, const Start<R, n>& state) {
    const Vector<R, k> q = Map<R>::angles(state.q);
    return {q, generalised_momenta(Map<R>(given), q, state.p)};
  }
  template <class R>
  static Start<R, n> from_angles(const Parameters<R>& given, const Start<R, k>& state) {
    const Map<R> map(given);
    return cartesian_state(map, map.mass(given), state);
  }

  template <std::size_t N>
  static Start<double, N> read(const std::vector<double>& q, const std::vector<double>& p) {
    Start<double, N> s;
    for (std::size_t i = 0; i < N; ++i) {
      s.q[i] = q.at(i);
      s.p[i] = p.at(i);
    }
    return s;
  }
  template <std::size_t N>
  static Frame frame_of(const Start<double, N>& s) {
    Frame frame;
    frame.q.assign(s.q.begin(), s.q.end());
    frame.p.assign(s.p.begin(), s.p.end());
    return frame;
  }
  static void add_to(ProblemEntry& entry) {
    entry.info.chart_key = FormulaKeys::coordinates;
    entry.to_reference = [](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
      return frame_of(to_angles(Parameters<double>(parameters), read<n>(q, p)));
    };
    entry.from_reference = [](const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p) {
      return frame_of(from_angles(Parameters<double>(parameters), read<k>(q, p)));
    };
  }
};

template <std::size_t N, class R>
Start<R, N> state_of(const DigitState& state) {
  Start<R, N> s{};
  for (std::size_t i = 0; i < N; ++i) {
    s.q[i] = evaluate_number<R>(state.q.at(i));
    s.p[i] = evaluate_number<R>(state.p.at(i));
  }
  return s;
}
template <class R, std::size_t N>
DigitState digits_of_state(const Start<R, N>& s) {
  DigitState state;
  for (const R& x : s.q) state.q.push_back(written_digits(x));
  for (const R& x : s.p) state.p.push_back(written_digits(x));
  return state;
}
template <template <class> class Map>
DigitCharts digit_charts(const Texts& parameters) {
  using Chart = ChartOfAngles<Map>;
  return {[parameters](const std::string& arithmetic, const DigitState& state) {
            return in_arithmetic(arithmetic, [&]<class R>() {
              return digits_of_state(Chart::to_angles(Parameters<R>(parameters), state_of<Chart::n, R>(state)));
            });
          },
          [parameters](const std::string& arithmetic, const DigitState& state) {
            return in_arithmetic(arithmetic, [&]<class R>() {
              return digits_of_state(Chart::from_angles(Parameters<R>(parameters), state_of<Chart::k, R>(state)));
            });
          }};
}

/// The exact motion of the plane pendulum, by elliptic functions of its angle.
std::optional<Frame> exact_pendulum(const Texts& parameters, const std::vector<double>& q, const std::vector<double>& p,
                                    double t) {
  using Chart = ChartOfAngles<Circle>;
  const Parameters<long double> given(parameters);
  const auto start = Chart::read<2>(q, p);
  const auto angle =
      Chart::to_angles(given, Start<long double, 2>{cast<long double>(start.q), cast<long double>(start.p)});
  const Pendulum<double> problem{Parameters<double>(parameters)};
  const LongMotion motion = [&](const LongState& z, long double time) -> std::optional<LongState> {
    const auto at = problem.exact({z[0]}, {z[1]}, time);
    if (!at) return std::nullopt;
    return LongState{at->q[0], at->p[0]};
  };
  const auto end = exact_state_if_accurate(motion, {angle.q[0], angle.p[0]}, t, {});
  if (!end) return std::nullopt;
  const auto there = Chart::from_angles(given, Start<long double, 1>{{(*end)[0]}, {(*end)[1]}});
  Frame frame = Chart::frame_of(Start<double, 2>{cast<double>(there.q), cast<double>(there.p)});
  frame.time = t;
  return frame;
}

/// A problem given by texts, with the parameters of another entry and the kinetic energy of point masses.
ProblemEntry entry_of_texts(const char* name, FormulaTexts texts, const std::string& form) {
  texts.constraint_form = form;
  const FormulaStructure structure{.separable = true,
                                   .quadratic_kinetic = true,
                                   .constraints = texts.constraints.size(),
                                   .multiplier = form == FormulaKeys::multiplier};
  ProblemEntry entry = entry_of_model({texts, structure});
  entry.structure = std::nullopt;  // the analysis of typed texts is not reported for a built-in problem
  entry.info.name = name;
  entry.info.coordinates = texts.coordinates;
  return entry;
}

ProblemEntry pendulum(int dimension, const std::string& form) {
  const bool plane = dimension == 2;
  FormulaTexts texts;
  texts.coordinates = plane ? std::vector<std::string>{"x", "y"} : std::vector<std::string>{"x", "y", "z"};
  texts.kinetic = plane ? "(p_x^2 + p_y^2)/(2*mass)" : "(p_x^2 + p_y^2 + p_z^2)/(2*mass)";
  texts.potential = plane ? "mass*gravity*y" : "mass*gravity*z";
  texts.constraints = {plane ? "x^2 + y^2 - length^2" : "x^2 + y^2 + z^2 - length^2"};
  if (!plane) texts.invariants = {{"angular_momentum", "x*p_y - y*p_x"}};
  texts.parameters = {
      {"mass", FormulaKeys::unknown}, {"length", FormulaKeys::unknown}, {"gravity", FormulaKeys::unknown}};
  ProblemEntry entry = entry_of_texts("pendulum", texts, form);
  ProblemInfo& info = entry.info;
  info.variant = {{FormulaKeys::coordinates, "cartesian"},
                  {"dimension", std::to_string(dimension)},
                  {FormulaKeys::constraint_form, form}};
  if (plane) info.default_choices.emplace_back("dimension");
  if (form == FormulaKeys::manifold) info.default_choices.emplace_back(FormulaKeys::constraint_form);
  info.formula = plane ? "H = |p|^2/(2 m) + m g y, x^2 + y^2 = l^2" : "H = |p|^2/(2 m) + m g z, x^2 + y^2 + z^2 = l^2";
  info.reference = "HLW2006, Sect. I.1.3, VII.1.1";
  info.parameters = Pendulum<double>::info().parameters;
  if (plane) {
    ChartOfAngles<Circle>::add_to(entry);
    entry.exact = exact_pendulum;
    info.region = {.centre = {0.9, 0.4, -0.2, 0.5}, .spread = 0.15, .time = 2.5};
    info.example = {.q = {0.6, -0.8}, .p = {0.8, 0.6}, .dt = 0.02};
  } else {
    info.invariants = {{"angular_momentum", "x p_y - y p_x, about the vertical", Components::one, Terms::moments}};
    info.region = {.centre = {0.8, 0.1, -0.6, -0.2, 0.7, 0.3}, .spread = 0.15, .time = 2.5};
    info.example = {.q = {0.6, 0, -0.8}, .p = {0.4, 0.9, 0.3}, .dt = 0.02};
  }
  return entry;
}

ProblemEntry double_pendulum(const std::string& form) {
  FormulaTexts texts;
  texts.coordinates = {"x1", "y1", "x2", "y2"};
  texts.kinetic = "(p_x1^2 + p_y1^2)/(2*masses[1]) + (p_x2^2 + p_y2^2)/(2*masses[2])";
  texts.potential = "gravity*(masses[1]*y1 + masses[2]*y2)";
  texts.constraints = {"x1^2 + y1^2 - half_lengths[1]^2", "(x2 - 2*x1)^2 + (y2 - 2*y1)^2 - half_lengths[2]^2"};
  texts.parameters = {{"masses", "[?, ?]"}, {"half_lengths", "[?, ?]"}, {"gravity", FormulaKeys::unknown}};
  ProblemEntry entry = entry_of_texts("double-pendulum", texts, form);
  ProblemInfo& info = entry.info;
  info.variant = {
      {"model", "nonlinear"}, {FormulaKeys::coordinates, "cartesian"}, {FormulaKeys::constraint_form, form}};
  if (form == FormulaKeys::manifold) info.default_choices.emplace_back(FormulaKeys::constraint_form);
  info.formula = "H = |p1|^2/(2 m1) + |p2|^2/(2 m2) + g (m1 y1 + m2 y2), |r1| = l1, |r2 - 2 r1| = l2";
  info.reference = "Gross1999, ch. 3";
  info.parameters = DoublePendulumBody<double>::parameters();
  entry.refused_parameters = [](const Texts& given) -> std::pair<std::string, std::string> {
    const Parameters<double> values(given);
    for (const double inertia : values.list("inertias")) {
      if (inertia != 0) return {"inertias", "allowed [0, 0] in Cartesian coordinates; otherwise use angles"};
    }
    return {};
  };
  ChartOfAngles<TwoRods>::add_to(entry);
  info.region = {.centre = {0.4, -0.9, 0.5, -2.75, 0.3, 0.1, 0.5, 0.1}, .spread = 0.05, .step = 0.02, .time = 0.7};
  info.example = {.q = {0.6, -0.8, 1.2, -2.6}, .p = {0.4, 0.3, 0.8, 0.6}, .dt = 0.005};
  return entry;
}

ProblemEntry t_tube(const std::string& form) {
  FormulaTexts texts;
  texts.coordinates = {"x1", "y1", "x2", "y2"};
  texts.kinetic = "(p_x1^2 + p_y1^2)/(2*masses[1]) + (p_x2^2 + p_y2^2)/(2*masses[2])";
  texts.potential = "-eps/sqrt((x1 - x2)^2 + (y1 - y2)^2)";
  texts.constraints = {"y1", "x2"};
  texts.parameters = {{"masses", "[?, ?]"}, {"eps", FormulaKeys::unknown}};
  ProblemEntry entry = entry_of_texts("t-tube", texts, form);
  ProblemInfo& info = entry.info;
  const ProblemInfo on_rails = TTube<double>::info();
  info.variant = {{FormulaKeys::coordinates, "cartesian"}, {FormulaKeys::constraint_form, form}};
  if (form == FormulaKeys::manifold) info.default_choices.emplace_back(FormulaKeys::constraint_form);
  info.formula = "H = |p1|^2/(2 m1) + |p2|^2/(2 m2) - eps/|r1 - r2|, y1 = x2 = 0, x1 in [-1, 1], y2 in [0.1, 2.1]";
  info.reference = on_rails.reference;
  info.parameters = on_rails.parameters;
  info.velocities = on_rails.velocities;
  info.velocity_places = {0, 3};
  info.default_q = {"0.01", "0", "0", "1.1"};
  info.walls = {{0, "-1", "1"}, {3, "0.1", "2.1"}};
  info.observables = {{"kinetic1", "p_x1^2/(2*masses[1])"}, {"kinetic2", "p_y2^2/(2*masses[2])"}};
  ChartOfAngles<Rails>::add_to(entry);
  info.region = {.parameters = on_rails.region.parameters,
                 .centre = {1, 0, 0, 0.25, 0.1, 0, 0, 1.1},
                 .spread = 0.05,
                 .step = 0.11,
                 .time = 2.3};
  info.example = {.parameters = on_rails.example.parameters,
                  .q = {0.01, 0, 0, 1.1},
                  .p = {0, 0, 0, 100},
                  .dt = 0.01,
                  .steps = 20000};
  return entry;
}

}  // namespace

DigitCharts constrained_digit_charts(const ProblemEntry& entry, const Texts& parameters) {
  if (!entry.to_reference) return {};
  if (entry.info.name == "t-tube") return digit_charts<Rails>(parameters);
  return entry.info.coordinates.size() == 2 ? digit_charts<Circle>(parameters) : digit_charts<TwoRods>(parameters);
}

std::vector<ProblemEntry> constrained_problems() {
  std::vector<ProblemEntry> all;
  for (const char* const form : {FormulaKeys::manifold, FormulaKeys::multiplier}) {
    for (const int dimension : {2, 3}) all.push_back(pendulum(dimension, form));
    all.push_back(double_pendulum(form));
    all.push_back(t_tube(form));
  }
  return all;
}

}  // namespace hamflow
