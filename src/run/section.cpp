#include "hamflow/run/section.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/numerics/root.hpp"

namespace hamflow {

double SectionSearch::distance(const Frame& frame) const {
  if (section_.expression) return (*section_.expression)(frame)-section_.value;
  return (section_.momentum ? frame.p : frame.q)[section_.coordinate] - section_.value;
}

/// At theta = 1 the run's own next state is meant, which has the other sign.
void SectionSearch::locate(const Simulation& before_step, double before, double now) {
  SectionPoint best;
  best.residual = std::numeric_limits<double>::infinity();
  const auto look = [&](double theta) {
    if (theta != theta) return 0.0;  // beside a pole the next guess is none
    failed_ = failed_ || before_step.look_part(theta, partial_) != Outcome::done;
    if (failed_) return 0.0;  // there is no state to look at
    const double x = distance(partial_);
    if (std::abs(x) < best.residual) best = {partial_.time, partial_.q, partial_.p, std::abs(x)};
    return x;
  };
  const double theta = bracketed_root([&](double at) { return failed_ ? 0 : look(at); }, 0.0, 1.0, before, now);
  (void)look(theta);
  if (failed_) return;
  // What is continuous has come down to its rounding, a jump or a pole has not.
  constexpr double at_most = 0x1p-10;
  if (!(best.residual <= at_most * std::max(std::abs(before), std::abs(now)))) {
    ++jumps_;
    return;
  }
  ++points_;
  max_residual_ = std::max(max_residual_, best.residual);
  found_(best);
}

SectionFinder::SectionFinder(const Simulation& simulation, const Section& section,
                             std::function<void(const SectionPoint&)> found)
    : simulation_(simulation), search_(section, std::move(found)) {}

Verdict SectionFinder::observe(const Frame& frame) {
  constexpr std::int64_t steps_behind = 64;
  const double now = search_.distance(frame);
  const bool first = !begun_;
  if (!first && search_.crosses(before_, now)) {
    if (copy_->advance(frame.step - 1 - copy_->step()) == Outcome::done) {
      search_.locate(*copy_, before_, now);
    } else {
      search_.give_up();
    }
  }
  before_ = now;
  begun_ = true;
  if (first || frame.step - copy_->step() >= steps_behind) copy_ = simulation_.clone();
  return Verdict::go_on;
}

/// A copy of the simulation is a copy of its bits, wherever it was taken.
void SectionFinder::archive(Reader& ar) {
  fields(ar);
  copy_ = begun_ ? simulation_.clone() : nullptr;
}

}  // namespace hamflow
