#include "hamflow/run/section.hpp"

#include <algorithm>
#include <cmath>

#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/numerics/root.hpp"

namespace hamflow {

namespace {

/// The weights that evaluate the polynomial through the values at 0 .. 4.
std::array<double, 5> weights_at(double at) {
  std::array<double, 5> weights{};
  for (std::size_t i = 0; i < weights.size(); ++i) {
    weights[i] = 1;
    for (std::size_t j = 0; j < weights.size(); ++j) {
      if (j != i) weights[i] *= (at - static_cast<double>(j)) / (static_cast<double>(i) - static_cast<double>(j));
    }
  }
  return weights;
}

std::int64_t bounces_of(const Simulation& simulation) {
  std::int64_t all = 0;
  for (const WallCount& wall : simulation.wall_counts()) all += wall.bounces;
  return all;
}

/// Whether a step enters or leaves the domain of the expression, as q1 = 0 for sqrt(q1). This is not a change of sign,
/// but the part of the step within the domain may have one.
bool passes_an_edge(double before, double now) { return std::isnan(before) != std::isnan(now); }

/// The largest |x| of a touch, relative to the size of x in the step: the rounding of x and of the place of its
/// minimum.
constexpr double touch = 0x1p-44;

}  // namespace

double SectionSearch::distance(const Frame& frame) const {
  if (section_.every_step) return 0;
  if (section_.expression) return (*section_.expression)(frame)-section_.value;
  return (section_.momentum ? frame.p : frame.q)[section_.coordinate] - section_.value;
}

bool SectionSearch::may_hide_zeros(double before, double now, bool bounced) {
  constexpr double safety = 4;
  constexpr double unknown = std::numeric_limits<double>::quiet_NaN();
  const double change = now - before;
  const double bend = std::abs(change - last_change_);
  const double most = safety * (bend > last_bend_ || std::isnan(last_bend_) ? bend : last_bend_);
  before_last_ = std::isnan(last_change_) ? unknown : before - last_change_;
  last_bend_ = bounced ? unknown : bend;
  last_change_ = bounced ? unknown : change;
  if (std::isnan(most)) return !std::isnan(change);
  if (!(most > 0)) return false;
  if ((before > most && now > most) || (before < -most && now < -most)) return false;  // nearly always, without roots
  // A parabola with that second derivative through both ends may have two zeros between them.
  if (before == 0 || now == 0 || (before > 0) == (now > 0)) {
    return std::sqrt(std::abs(before)) + std::sqrt(std::abs(now)) <= std::sqrt(most / 2);
  }
  return std::abs(change) <= most / 2;  // x has two extrema in between
}

void SectionSearch::locate(const Simulation& before_step, double before, double now) {
  locate(before_step, Change{0, 1, before, now});
}

/// At theta = 1 the next state of the run is used, which has the other sign.
void SectionSearch::locate(const Simulation& before_step, const Change& given) {
  Change change = given;
  if (passes_an_edge(given.before, given.now)) {
    const bool enters = std::isnan(given.before);
    double outside = enters ? given.from : given.to;
    double& inside = enters ? change.from : change.to;
    double& x = enters ? change.before : change.now;
    inside = enters ? given.to : given.from;
    x = enters ? given.now : given.before;
    for (int i = 0; i < 60 && !failed_; ++i) {  // bisects to the digits of theta
      const double middle = (outside + inside) / 2;
      const double there = sample(before_step, middle).x;
      if (std::isnan(there)) {
        outside = middle;
      } else {
        inside = middle;
        x = there;
      }
    }
    if (failed_ || !crosses(change.before, change.now)) return;
  }
  SectionPoint best;
  best.residual = std::numeric_limits<double>::infinity();
  double theta_of_best = std::numeric_limits<double>::quiet_NaN();
  const auto look = [&](double theta) {
    if (theta != theta) return 0.0;  // near a pole the next guess may be NaN
    failed_ = failed_ || before_step.look_part(theta, partial_) != Outcome::done;
    if (failed_) return 0.0;  // there is no state
    const double x = distance(partial_);
    if (std::abs(x) < best.residual) {
      best.time = partial_.time;  // field by field, without new vectors
      best.q = partial_.q;
      best.p = partial_.p;
      best.residual = std::abs(x);
      if (!partial_.digits.q.empty()) best.digits = partial_.digits;
      theta_of_best = theta;
    }
    return x;
  };
  const double theta = bracketed_root([&](double at) { return failed_ ? 0 : look(at); }, change.from, change.to,
                                      change.before, change.now);
  if (theta != theta_of_best) (void)look(theta);
  if (failed_) return;
  // At a zero of a continuous expression x is at rounding level; at a jump or a pole it is not.
  constexpr double at_most = 0x1p-10;
  if (!(best.residual <= at_most * std::max(std::abs(change.before), std::abs(change.now)))) {
    ++jumps_;
    return;
  }
  if (!best.digits.q.empty() && (!section_.expression || section_.in_digits)) refine(before_step, best);
  take(best);
}

/// For a run with more digits than double: refines the zero found in double by the secant method, in the digits of the
/// run, until there is no improvement. Each step nearly doubles the digits.
void SectionSearch::refine(const Simulation& before_step, SectionPoint& point) const {
  constexpr int most_looks = 64;
  std::size_t longest = point.digits.time.size();
  for (const auto* texts : {&point.digits.q, &point.digits.p}) {
    for (const std::string& text : *texts) longest = std::max(longest, text.size());
  }
  const MpDigits scope(static_cast<int>(std::clamp<std::size_t>(longest, MpDigits::fewest, MpDigits::most)));
  const Mp value = section_.value_text.empty() ? Mp(section_.value) : evaluate_number<Mp>(section_.value_text);
  const auto distance_of = [&](const FrameDigits& digits) {
    if (section_.in_digits) return Mp(section_.in_digits(digits) - value);
    return Mp(parse_decimal<Mp>((section_.momentum ? digits.p : digits.q)[section_.coordinate]) - value);
  };
  Frame frame;
  before_step.look(frame);
  Mp t = parse_decimal<Mp>(point.digits.time);
  Mp x = distance_of(point.digits);
  Mp least = abs(x);
  Mp next = t - (t - parse_decimal<Mp>(frame.digits.time)) * Mp(0x1p-20);
  int idle = 0;
  for (int i = 0; i < most_looks && idle < 2 && least > Mp(0); ++i) {
    if (before_step.look_ahead(written_digits(next), frame) != Outcome::done) break;
    const Mp there = distance_of(frame.digits);
    ++idle;
    if (abs(there) < least) {
      idle = 0;
      least = abs(there);
      point.time = frame.time;
      point.q = frame.q;
      point.p = frame.p;
      point.digits = frame.digits;
    }
    if (there == x) break;
    const Mp after = next - there * (next - t) / (there - x);
    t = next;
    x = there;
    next = after;
  }
  point.residual = static_cast<double>(least);
  if (least > Mp(0)) point.residual = std::max(point.residual, std::numeric_limits<double>::min());  // it is not 0
}

std::string jumps_text(std::int64_t jumps) {
  return (jumps == 1 ? std::string("1 change") : std::to_string(jumps) + " changes") + " of sign " +
         (jumps == 1 ? "was not a zero" : "were not zeros") + ": the expression jumps or has a pole there";
}

std::string SectionSearch::message() const {
  std::string all = jumps_ > 0 ? jumps_text(jumps_) : std::string();
  if (failed_)
    all += (all.empty() ? "" : "; ") + std::string("a partial step failed, and points after it were not searched for");
  return all;
}

void SectionSearch::take(const SectionPoint& point) {
  ++points_;
  max_residual_ = std::max(max_residual_, point.residual);
  found_(point);
}

void SectionSearch::locate_in_failed_step(const Simulation& before_step, double before) {
  double reached = 0;
  double lost = 1;
  for (int i = 0; i < 50 && !failed_; ++i) {
    const double theta = (reached + lost) / 2;
    if (before_step.look_part(theta, partial_) != Outcome::done) {
      lost = theta;
      continue;
    }
    const double now = distance(partial_);
    if (crosses(before, now)) return locate(before_step, Change{reached, theta, before, now});
    reached = theta;
    before = now;
  }
}

SectionSearch::Sample SectionSearch::sample_of(double theta, const Frame& frame) const {
  Sample sample{theta, distance(frame), {}};
  sample.state.reserve(frame.q.size() + frame.p.size());
  sample.state.insert(sample.state.end(), frame.q.begin(), frame.q.end());
  sample.state.insert(sample.state.end(), frame.p.begin(), frame.p.end());
  return sample;
}

SectionSearch::Sample SectionSearch::sample(const Simulation& before_step, double theta) {
  ++looks_;
  if (before_step.look_part(theta, partial_) == Outcome::done) return sample_of(theta, partial_);
  failed_ = true;
  return {theta, 0, {}};
}

void SectionSearch::complete(const Simulation& before_step, Piece& piece) {
  for (const std::size_t k : {1u, 3u}) {
    if (!failed_) piece[k] = sample(before_step, (piece[k - 1].theta + piece[k + 1].theta) / 2);
  }
}

/// Whether a weighted sum of five points equals a sixth one, relative to their range. Changes by rounding or by a loose
/// tolerance of numbers that are otherwise constant are ignored.
bool SectionSearch::has(const Piece& piece, const std::array<double, 5>& weights, const Sample& sample,
                        double parts) const {
  using Values = std::array<double, 5>;
  const auto range_of = [](const Values& values) {
    std::pair range(values[0], values[0]);
    for (const double each : values) range = {std::min(range.first, each), std::max(range.second, each)};
    return range;
  };
  const auto is_off = [&](const Values& values, double there, double most) {
    double sum = 0;
    for (std::size_t k = 0; k < values.size(); ++k) sum += weights[k] * values[k];
    const auto [low, high] = range_of(values);
    const double size = std::max(std::abs(low), std::abs(high));
    const double enough = std::max(std::max((high - low) / parts, 1e-6 * most), 1e-9 * size);
    return std::abs(there - sum) > enough;  // false for NaN, which bisection does not remove
  };
  const auto numbers = [&](std::size_t i) {
    return Values{piece[0].state[i], piece[1].state[i], piece[2].state[i], piece[3].state[i], piece[4].state[i]};
  };
  const std::size_t n = sample.state.size() / 2;
  for (const std::size_t first : {std::size_t{0}, n}) {
    double most = 0;  // range of the number that moves most
    for (std::size_t i = first; i < first + n; ++i) {
      const auto [low, high] = range_of(numbers(i));
      most = std::max(most, high - low);
    }
    for (std::size_t i = first; i < first + n; ++i) {
      if (is_off(numbers(i), sample.state[i], most)) return false;
    }
  }
  if (!section_.expression) return true;
  return !is_off({piece[0].x, piece[1].x, piece[2].x, piece[3].x, piece[4].x}, sample.x, 0);
}

/// Whether the middle one of five points lies on a cubic through the others, and another point, at a ratio that
/// resonates with none of them, on the polynomial through all five. Then the motion between the points is known.
bool SectionSearch::is_cubic(const Simulation& before_step, const Piece& piece, double parts) {
  if (!has(piece, {-1.0 / 6, 4.0 / 6, 0, 4.0 / 6, -1.0 / 6}, piece[2], parts)) return false;
  const double at = 0.3819660112501051;  // the golden section
  const Sample other = sample(before_step, piece[0].theta + at * (piece[4].theta - piece[0].theta));
  return failed_ || has(piece, weights_at(4 * at), other, parts);
}

bool SectionSearch::is_long(const Simulation& before_step) {
  if (failed_) return false;
  constexpr std::size_t most_numbers = 20000;  // larger systems would need the memory of several runs
  const auto half_is_long = [&](double from) {
    Piece half;
    for (const std::size_t k : {0u, 2u, 4u}) {
      if (!failed_) half[k] = sample(before_step, from + static_cast<double>(k) / 8);
      if (half[k].state.size() > most_numbers) return false;
    }
    complete(before_step, half);
    return !failed_ && !is_cubic(before_step, half, 256) && !failed_;
  };
  const bool found = half_is_long(0) && half_is_long(0.5);
  failed_ = false;  // the caller does not need this point
  return found;
}

void SectionSearch::note_change(double from, double to, double before, double now) {
  const bool is_change = before != 0 && (now == 0 || (now > 0) != (before > 0));
  if (is_change || passes_an_edge(before, now)) changes_.push_back({from, to, before, now});
}

/// Searches for two crossings, or a touch, between two samples of the same sign, if the polynomial through all five
/// comes near 0.
void SectionSearch::see_between(const Simulation& before_step, const Piece& piece, std::size_t k) {
  const Sample& left = piece[k];
  const Sample& right = piece[k + 1];
  const double sign = left.x > 0 ? 1 : -1;
  if (!(left.x * sign > 0 && right.x * sign > 0)) {
    note_change(left.theta, right.theta, left.x, right.x);
    return;
  }
  double size = 0;
  for (const Sample& each : piece) size = std::max(size, std::abs(each.x));
  const auto polynomial = [&](double at) {
    const std::array<double, 5> weights = weights_at(at);
    double sum = 0;
    for (std::size_t i = 0; i < piece.size(); ++i) sum += weights[i] * piece[i].x;
    return sign * sum;
  };
  constexpr int points = 32;
  int nearest = 0;
  double least = left.x * sign;
  for (int i = 1; i <= points; ++i) {
    const double x = i < points ? polynomial(static_cast<double>(k) + i / static_cast<double>(points)) : right.x * sign;
    if (x < least) {
      least = x;
      nearest = i;
    }
  }
  if (!(least <= size / 64)) return;
  const auto falls_from = [&](double end, double inwards) { return polynomial(end + inwards) < polynomial(end); };
  if (nearest == 0 && !falls_from(static_cast<double>(k), 0x1p-12)) {
    // A touch at the end of the step, up to rounding: x came from the same side and goes back.
    const bool at_start = left.theta == 0 && before_last_ * sign > left.x * sign;
    if (at_start && left.x * sign <= touch * size) note_touch(0, sign);
    return;
  }
  if (nearest == points && !falls_from(static_cast<double>(k + 1), -0x1p-12)) return;
  // Golden section search; 40 iterations leave an error of 10^-9 in the place and of its square in x.
  const double width = (right.theta - left.theta) / points;
  const double golden = (std::sqrt(5.0) - 1) / 2;
  double from = left.theta + std::max(nearest - 1, 0) * width;
  double to = left.theta + std::min(nearest + 1, points) * width;
  double inner = to - golden * (to - from);
  double outer = from + golden * (to - from);
  const auto x_at = [&](double theta) { return failed_ ? 0 : sample(before_step, theta).x; };
  double x_inner = x_at(inner);
  double x_outer = x_at(outer);
  for (int i = 0; i < 40 && !failed_; ++i) {
    const bool inner_is_less = x_inner * sign < x_outer * sign;
    const double theta = inner_is_less ? inner : outer;
    const double x = inner_is_less ? x_inner : x_outer;
    if (x * sign < -touch * size) {
      note_change(left.theta, theta, left.x, x);
      note_change(theta, right.theta, x, right.x);
      return;
    }
    if (inner_is_less) {
      to = outer;
      outer = inner;
      x_outer = x_inner;
      x_inner = x_at(inner = to - golden * (to - from));
    } else {
      from = inner;
      inner = outer;
      x_inner = x_outer;
      x_outer = x_at(outer = from + golden * (to - from));
    }
  }
  const bool inner_is_less = x_inner * sign < x_outer * sign;
  const bool touches = (inner_is_less ? x_inner : x_outer) * sign <= touch * size;
  if (!failed_ && touches) note_touch(inner_is_less ? inner : outer, sign);
}

void SectionSearch::see(const Simulation& before_step, Piece& piece, int depth) {
  constexpr int deepest = 14;
  constexpr int most_looks = 4096;
  if (failed_) return;
  if (depth == deepest || looks_ > most_looks || is_cubic(before_step, piece, 64)) {
    // A bounce, a kink or a jump is not cubic on any scale.
    too_coarse_ = too_coarse_ || (looks_ > most_looks && depth < deepest);
    for (std::size_t k = 0; k + 1 < piece.size(); ++k) see_between(before_step, piece, k);
    return;
  }
  for (const std::size_t first : {0u, 2u}) {
    Piece half{piece[first], {}, piece[first + 1], {}, piece[first + 2]};
    complete(before_step, half);
    see(before_step, half, depth + 1);
  }
}

void SectionSearch::locate_all(const Simulation& before_step, double before, const Frame& frame, double now,
                               bool bounced) {
  if (failed_) return;
  changes_.clear();
  looks_ = 0;
  too_coarse_ = false;
  Piece whole;
  for (std::size_t k = 0; k < whole.size(); ++k) {
    if (!failed_) whole[k] = sample(before_step, static_cast<double>(k) / 4);
  }
  if (failed_) return;
  // The run did not follow a path that walls rejected.
  const Sample end = sample_of(1, frame);
  bool is_that_of_the_run = true;
  for (std::size_t i = 0; i < end.state.size(); ++i) {
    double range = 0;
    for (const Sample& each : whole) range = std::max(range, std::abs(each.state[i] - whole[0].state[i]));
    const double size = std::max(std::abs(end.state[i]), std::abs(whole[0].state[i]));
    is_that_of_the_run = is_that_of_the_run && std::abs(whole[4].state[i] - end.state[i]) <= range / 4 + 1e-6 * size;
  }
  whole[4] = end;
  if (is_that_of_the_run) see(before_step, whole, 0);
  if ((!is_that_of_the_run && !bounced) || too_coarse_) ++unseen_;
  if (!is_that_of_the_run) note_change(0, 1, before, now);
  const bool is_alone = changes_.size() == 1 && before != 0 && (now == 0 || (now > 0) != (before > 0));
  if (is_alone) changes_.front() = {0, 1, before, now};
  for (const Change& change : changes_) {
    if (failed_) break;
    if (change.from == change.to) {
      if (!crosses(change.before, 0)) continue;
      const double x = sample(before_step, change.from).x;
      if (!failed_) take({partial_.time, partial_.q, partial_.p, std::abs(x), partial_.digits});
    } else if (crosses(change.before, change.now) || passes_an_edge(change.before, change.now))
      locate(before_step, change);
  }
}

SectionFinder::SectionFinder(const Simulation& simulation, const Section& section,
                             std::function<void(const SectionPoint&)> found)
    : simulation_(simulation),
      search_(section, std::move(found)),
      has_own_substeps_(simulation.method().own_substeps),
      order_(simulation.method().order) {}

Verdict SectionFinder::observe(const Frame& frame) {
  constexpr std::int64_t steps_behind = 64;
  const double now = search_.distance(frame);
  if (search_.section().by_steps) {
    if (begun_ && frame.step > work_) search_.take_step(before_, now, frame);
    work_ = frame.step;
    before_ = now;
    begun_ = true;
    return Verdict::go_on;
  }
  const long long work = frame.effort.force + frame.effort.gradient;
  const bool first = !begun_;
  const bool stepped = !first && frame.step > copy_->step();  // a continued run shows its present state again
  // One sub-step costs as many evaluations as a series has terms, or one and a half times the order for the stages of
  // dop853.
  const std::int64_t bounces = bounces_of(simulation_);
  const bool bounced = bounces != bounces_;
  const bool is_long = has_own_substeps_ ? 2 * (work - work_) > 3 * order_ : search_.is_long();
  const bool hides = stepped && search_.may_hide_zeros(before_, now, bounced);
  const bool looks_into = is_long || bounced || hides;
  if (stepped && (looks_into || search_.crosses(before_, now) || passes_an_edge(before_, now))) {
    if (copy_->advance(frame.step - 1 - copy_->step()) != Outcome::done) {
      search_.give_up();
    } else if (looks_into) {
      search_.locate_all(*copy_, before_, frame, now, bounced && !is_long);
    } else {
      search_.locate(*copy_, before_, now);
    }
  }
  before_ = now;
  work_ = work;
  bounces_ = bounces;
  begun_ = true;
  if (first || frame.step % steps_behind == 0) copy_ = simulation_.clone();
  if (!has_own_substeps_ && search_.is_to_measure(frame.step)) search_.measure(*copy_);
  return Verdict::go_on;
}

/// The copy of the simulation is restored by copying the simulation, which has the same bits.
void SectionFinder::archive(Reader& ar) {
  fields(ar);
  copy_ = begun_ ? simulation_.clone() : nullptr;
  bounces_ = bounces_of(simulation_);
}

}  // namespace hamflow
