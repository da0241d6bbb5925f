// Measures the drift of the energy of cg per step, divided by |T| + |V| at the start, over 32 starts of four problems.
// The problems cover every way to solve a step. Energies are computed in quad with all digits of the state.
//     energy_drift [steps [problem [start]]]      steps of each start, default 10^7
// The standard error of a start comes from the changes over 256 blocks. A random walk of w per step hides drifts below
// w/sqrt(32 steps), so a drift of 1e-22 takes 10^8 steps and hours.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <vector>

#include "drift_systems.hpp"
#include "hamflow/arithmetic/compensated.hpp"
#include "hamflow/methods/cg.hpp"

namespace {

using namespace hamflow;
using namespace hamflow::drift;
using A = Compensated<double>;
constexpr long blocks = 256;

template <class System>
void row(const Asked& asked) {
  if (!asked.system.empty() && asked.system != System::name) return;
  using P = decltype(System::template made<double>());
  constexpr std::size_t n = P::dimension;
  const P problem = System::template made<double>();
  const auto in_quad = System::template made<Quad>();
  const long steps = asked.steps / blocks;
  std::vector<Mean> means;
  for (std::uint64_t s = asked.first(); s < asked.end(); ++s) {
    const Begin from = System::start(s);
    auto z = stored<A, n>(from);
    ContinuousGalerkin<P, A> method(problem, CgOptions{.quadrature = System::points});
    std::vector<double> increments;
    Quad before = energy_of(in_quad, z);
    for (long b = 0; b < blocks; ++b) {
      for (long k = 0; k < steps; ++k) {
        if (method.step(problem, from.h, z) != Outcome::done) {
          std::printf("%s: start %d failed\n", System::name, static_cast<int>(s));
          std::exit(1);
        }
      }
      const Quad now = energy_of(in_quad, z);
      increments.push_back(static_cast<double>(now - before) / System::scale / static_cast<double>(steps));
      before = now;
    }
    means.push_back(mean_of(increments));
  }
  const Summary all(means);
  std::printf("%-16s %10.2e +- %.1e   one start +- %.1e   mean t^2 %6.2f   largest |t| %5.1f\n", System::name, all.mean,
              all.error, all.error_of_one, all.squares, all.largest_t);
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const Asked asked(argc, argv, 10'000'000);
  std::printf("energy gained a step, of the scale: mean over %d starts of %ld steps\n",
              static_cast<int>(asked.end() - asked.first()), asked.steps);
  row<PendulumStarts>(asked);
  row<KeplerStarts>(asked);
  row<PolarStarts>(asked);
  row<HenonHeilesStarts>(asked);
  row<DoublePendulumStarts>(asked);
}
