#include "hamflow/run/section.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/numerics/root.hpp"

namespace hamflow {

SectionFinder::SectionFinder(const Simulation& simulation, const Section& section,
                             std::function<void(const SectionPoint&)> found)
    : simulation_(simulation), section_(section), found_(std::move(found)) {}

double SectionFinder::distance(const Frame& frame) const {
  if (section_.expression) return (*section_.expression)(frame)-section_.value;
  return (section_.momentum ? frame.p : frame.q)[section_.coordinate] - section_.value;
}

Verdict SectionFinder::observe(const Frame& frame) {
  constexpr std::int64_t steps_behind = 64;
  const double now = distance(frame);
  const double before = before_;
  before_ = now;
  const bool first = !begun_;
  begun_ = true;
  const bool crosses = !first && before != 0 && (now == 0 || (now > 0) != (before > 0));
  const int direction = before < 0 ? 1 : -1;
  if (crosses && (section_.direction == 0 || section_.direction == direction)) {
    failed_ = !locate(frame.step - 1, before, now);
  }
  if (first || frame.step - copy_->step() >= steps_behind) copy_ = simulation_.clone();
  return Verdict::go_on;
}

/// A copy of the simulation is a copy of its bits, wherever it was taken.
void SectionFinder::archive(Reader& ar) {
  fields(ar);
  copy_ = begun_ ? simulation_.clone() : nullptr;
}

/// At theta = 1 the run's own next state is meant, which has the other sign.
bool SectionFinder::locate(std::int64_t step, double before, double after) {
  if (copy_->advance(step - copy_->step()) != Outcome::done) return false;
  SectionPoint best;
  best.residual = std::numeric_limits<double>::infinity();
  bool good = true;
  const auto look = [&](double theta) {
    good = good && copy_->look_part(theta, partial_) == Outcome::done;
    const double x = distance(partial_);
    if (good && std::abs(x) < best.residual) best = {partial_.time, partial_.q, partial_.p, std::abs(x)};
    return x;
  };
  const double theta = bracketed_root([&](double at) { return good ? look(at) : 0; }, 0.0, 1.0, before, after);
  (void)look(theta);
  if (!good) return false;
  ++points_;
  max_residual_ = std::max(max_residual_, best.residual);
  found_(best);
  return true;
}

}  // namespace hamflow
