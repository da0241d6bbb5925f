// Finds the rounding that makes the energy of cg drift. It compares the mean of each part of the energy change of a
// step (step_parts.hpp) with its variance, over 32 starts of four systems. A part with small roundings, such as that of
// the stopping rule, shows its mean early; the energy itself would show it only after 10^10 steps.
//     energy_parts [steps [system [start]]]      steps of each start, default 10^6, in 128 blocks
//     energy_parts check                         tests this program and its findings; takes seconds
// Means are per step, divided by |T| + |V|. "+-" is the standard error of the mean over all starts, from the blocks; t
// is mean/error, and the largest t is that of a single start. The exit status is 1 if the parts do not add up to the
// change of the energy in quad, or if observing a step changes it.
#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "drift_systems.hpp"
#include "step_parts.hpp"

namespace {

using namespace hamflow;
using namespace hamflow::drift;
constexpr long blocks = 128;

/// The means of the parts of a step and of their sum.
struct Means {
  std::array<Mean, sources + 1> of{};
  bool right = true;
};

/// Integrates one start of a system, and splits its steps.
template <class System, template <class, class> class Split>
class Walk {
 public:
  using P = decltype(System::template made<double>());
  using Precise = decltype(System::template made<Long>());
  static constexpr std::size_t n = P::dimension;
  using E = RecordingEquations<typename Split<P, Precise>::E>;
  using State = PhasePoint<A, n>;
  using Sums = std::array<double, sources + 1>;  // the parts, then their sum

  explicit Walk(std::uint64_t start) : begin_(System::start(start)), z_(stored<A, n>(begin_)) {}

  Means means(long steps) {
    const long block = std::max(2L, steps / blocks);
    ContinuousGalerkin<P, A, E> method(problem_, options);
    check_unwatched(std::min(block, 1000L));
    std::array<std::vector<double>, sources + 1> all;
    for (long b = 0; b < blocks; ++b) {
      Sums sums{};
      const Quad before = energy_of(in_quad_, z_);
      for (long k = 0; k < block; ++k) {
        const State from = z_;
        right_ = right_ && method.step(problem_, begin_.h, z_) == Outcome::done;
        const Parts parts = split_(from, E::last);
        for (std::size_t i = 0; i < sources; ++i) {
          sums[i] += parts[i];
          sums[sources] += parts[i];
        }
      }
      check_sum(static_cast<double>(energy_of(in_quad_, z_) - before), sums[sources], block);
      for (std::size_t i = 0; i <= sources; ++i) {
        all[i].push_back(sums[i] / System::scale / static_cast<double>(block));
      }
    }
    Means out{{}, right_};
    for (std::size_t i = 0; i <= sources; ++i) out.of[i] = mean_of(all[i]);
    return out;
  }

 private:
  static constexpr CgOptions options{.quadrature = System::points};

  /// Checks that the parts add up to the change of the energy. Long double leaves random errors of 1e-20 per step.
  void check_sum(double gained, double of_parts, long steps) {
    const double missed = (gained - of_parts) / System::scale;
    if (std::abs(missed) < 8e-20 * std::sqrt(static_cast<double>(steps))) return;
    std::printf("parts of %ld steps miss the gain %.3e by %.3e\n", steps, gained / System::scale, missed);
    right_ = false;
  }
  /// Checks that steps have the same bits when they are not observed.
  void check_unwatched(long steps) {
    ContinuousGalerkin<P, A> unwatched(problem_, options);
    ContinuousGalerkin<P, A, E> watched(problem_, options);
    State a = z_;
    State b = z_;
    for (long k = 0; k < steps; ++k) {
      right_ = right_ && unwatched.step(problem_, begin_.h, a) == Outcome::done;
      right_ = right_ && watched.step(problem_, begin_.h, b) == Outcome::done && a.q == b.q && a.p == b.p;
    }
  }

  const Begin begin_;
  const P problem_ = System::template made<double>();
  const Precise precise_ = System::template made<Long>();
  const decltype(System::template made<Quad>()) in_quad_ = System::template made<Quad>();
  const Split<P, Precise> split_{problem_, precise_, begin_.h, System::points};
  State z_;
  bool right_ = true;
};

template <class System, template <class, class> class Split>
bool table(const Asked& asked) {
  if (!asked.system.empty() && asked.system != System::name) return true;
  std::array<std::vector<Mean>, sources + 1> of;
  bool right = true;
  for (std::uint64_t s = asked.first(); s < asked.end(); ++s) {
    const Means means = Walk<System, Split>(s).means(asked.steps);
    right = right && means.right;
    for (std::size_t i = 0; i <= sources; ++i) of[i].push_back(means.of[i]);
  }
  for (std::size_t i = 0; i <= sources; ++i) {
    const Summary all(of[i]);
    std::printf("%-16s%-10s%10.2e +- %.1e   one start: +- %.1e  largest %.1e  mean t^2 %6.2f  largest |t| %5.1f\n",
                System::name, i < sources ? source_names[i] : "all", all.mean, all.error, all.error_of_one, all.largest,
                all.squares, all.largest_t);
  }
  if (!right) std::printf("%s: the parts are not those of the steps\n", System::name);
  std::fflush(stdout);
  return right;
}

bool tables(const Asked& asked) {
  bool right = table<PendulumStarts, NaturalParts>(asked);
  right = table<KeplerStarts, NaturalParts>(asked) && right;
  right = table<HenonHeilesStarts, NaturalParts>(asked) && right;
  return table<DoublePendulumStarts, GeneralParts>(asked) && right;
}

/// Checks that two sources of drift that were found and removed do not return. Rounding the increment of p of the
/// pendulum had the mean 1.5e-21, which was 7 standard errors. The stopping rule had 1.8e-21 on this double pendulum,
/// 18 standard errors.
bool check() {
  bool right = tables(Asked(2 * blocks));
  const Mean rounded = Walk<PendulumStarts, NaturalParts>(starts).means(1'000'000).of[rounded_p];
  const Mean left = Walk<DoublePendulumStarts, GeneralParts>(20).means(64'000).of[undone];
  std::printf("rounding of the impulse %.2e +- %.1e, allowed 4 errors\n", rounded.mean, rounded.error);
  std::printf("left by the stopping rule %.2e +- %.1e, allowed 1e-22\n", left.mean, left.error);
  return right && std::abs(rounded.mean) < 4 * rounded.error && std::abs(left.mean) < 1e-22;
}

}  // namespace

int main(int argc, char** argv) {
  if (argc > 1 && std::string(argv[1]) == "check") return check() ? 0 : 1;
  return tables(Asked(argc, argv, 1'000'000)) ? 0 : 1;
}
