#include "hamflow/verify/certify_step.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <limits>
#include <numbers>
#include <span>

#include "engine/make_simulation.hpp"
#include "hamflow/core/complaint.hpp"
#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/text.hpp"
#include "hamflow/detail/verify/drift.hpp"
#include "hamflow/run/walls.hpp"
#include "rounding.hpp"
#include "step_test_states.hpp"

namespace hamflow {

namespace {

// rounding of a scaled state: an iteration that ends at 1e-13 counts as exact
constexpr double rounding_of_scaled_state = 0x1p-40;
constexpr double exact_to_rounding = 0x1p-44;  // 256 roundings; an adaptive method with a small tolerance makes more
constexpr double least_error_over_rounding =
    1024;  // an error of the method has to be this many times the rounding error
// a defect above this fraction of the error belongs to the method, not to its solver
constexpr double largest_solver_share = 0x1p-10;
constexpr double most_error = 0.3;  // error of a scaled state; a step with a larger error shows nothing
constexpr double smooth = 0.02;     // an error with more noise comes from rounding or from a solver
constexpr const char* energy_name = "energy";

/// Central differences of order 6 along one direction, from the two difference lengths that agree best.
struct Derivative {
  State<double> value;
  double uncertainty = 0;
};

/// The defect of a property for one step size, with the error of the step and the error that rounding explains.
struct StepDefect {
  double h = 0;
  double defect = 0;
  double rounding = 0;
  double error = 0;
  double noise = 0;  // the part of the error that is not a smooth function of h
  bool is_smooth() const { return noise <= smooth; }
  bool is_decided() const { return is_smooth() && error >= least_error_over_rounding * rounding; }
  bool is_kept() const { return defect <= 4 * rounding; }
  bool is_violated() const { return defect > 32 * rounding && defect > largest_solver_share * error; }
};

/// The conclusion from the votes of all step sizes.
struct PropertyVerdict {
  std::optional<bool> holds;
  std::string reason;
};
/// Explains why too few votes separate the error of the method from rounding.
std::string why_undecided(const std::vector<StepDefect>& votes) {
  if (votes.empty()) return fmt::format("no step has an error below {} of the size of the state", most_error);
  const StepDefect& last = votes.back();
  const auto is_small = [](const StepDefect& vote) {
    return vote.error < least_error_over_rounding * rounding_of_scaled_state;
  };
  if (std::all_of(votes.begin(), votes.end(), is_small)) {
    return fmt::format(
        "the error of the step, {:.1e} with h = {:.3g}, is less than {:.0f} times the {:.1e} that rounding explains",
        last.error, last.h, least_error_over_rounding, rounding_of_scaled_state);
  }
  for (const StepDefect& vote : votes) {
    if (vote.is_smooth() || is_small(vote)) continue;
    return fmt::format(
        "the error is not a smooth function of h: with h = {:.3g} the error of the step is {:.1e}, and {:.0f} % of it "
        "is "
        "noise",
        vote.h, vote.error, 100 * std::min(vote.noise, 1.0));
  }
  const auto decided =
      std::count_if(votes.begin(), votes.end(), [](const StepDefect& vote) { return vote.is_decided(); });
  if (decided == 0) {
    return fmt::format(
        "the step is not a smooth function of q and p: its derivatives by differences are uncertain by {:.1e} with "
        "h = {:.3g}, where the error of the step is {:.1e}",
        last.rounding, last.h, last.error);
  }
  return fmt::format(
      "the error of the step is well above rounding only with h = {:.3g}, where it is {:.1e}; at least two step sizes "
      "are needed",
      last.h, last.error);
}
PropertyVerdict verdict_of(const std::vector<StepDefect>& votes, const std::string& property) {
  int kept = 0;
  bool is_exact = !votes.empty();
  const StepDefect* between = nullptr;
  for (const StepDefect& vote : votes) {
    if (vote.is_violated()) {
      return {false, fmt::format("{}: a defect of {:.1e} with h = {:.3g}, where the error of the step is {:.1e}",
                                 property, vote.defect, vote.h, vote.error)};
    }
    if (!vote.is_kept()) {
      between = &vote;
    } else if (vote.is_decided()) {
      ++kept;
    }
    is_exact = is_exact && vote.is_kept() && vote.error <= exact_to_rounding;
  }
  if (between != nullptr) {
    return {std::nullopt,
            fmt::format("{} undecided: a defect of {:.1e} with h = {:.3g}, more than the {:.1e} that rounding explains "
                        "but much less than the error of the step, {:.1e}",
                        property, between->defect, between->h, 4 * between->rounding, between->error)};
  }
  if (kept >= 2 || is_exact) return {true, {}};
  return {std::nullopt, property + " undecided: " + why_undecided(votes)};
}

class StepExamination {
 public:
  StepExamination(const ForeignStep& step, const StepProblem& problem, const StepClaims& claims)
      : step_(step), problem_(problem), claims_(claims), around_(step_test_states(problem)) {
    flow_ = exact_flow();
    short_step_ = 2 * std::numbers::pi / 60 / around_.frequency;
    check_motion();
  }

  StepCertificate certificate() {
    check_names();
    check_repeatable();
    measure_order();
    if (is_single_precision_) {
      reasons_.push_back(
          "all numbers that the step returns are in single precision, so structure is undecided; compute in double");
      for (const std::string& name : names()) found_.preserves.emplace_back(name, std::nullopt);
    } else {
      measure_structure();
    }
    check_repeated();
    compare();
    found_.reason = reasons_.empty() ? "every property was decided" : joined(reasons_, "; ");
    return found_;
  }

 private:
  /// Returns the flow of the problem in long double: a Taylor series, or dop853, with adaptive sub-steps whose
  /// tolerance is relative to the sizes of q and of p.
  std::unique_ptr<StepMap> exact_flow() const {
    for (const char* method : {"taylor", "dop853"}) {
      const Request request{.problem = problem_.entry->info.name,
                            .variant = problem_.variant,
                            .parameters = problem_.parameters,
                            .start = {},
                            .method = {.name = method, .options = {{"tolerance", "1e-18"}}}};
      if (!problem_.entry->accepts(request.method)) continue;
      if (auto flow = problem_.entry->step_map(request, size() / 2)) return flow;
    }
    throw Error("single steps cannot be measured on " + problem_.entry->info.name);
  }

  /// Returns the state after the time h; nullopt if the motion cannot be integrated so far.
  std::optional<State<long double>> exact(const State<double>& z, double h) const {
    State<long double> end(z.begin(), z.end());
    if (!flow_->advance(end, static_cast<long double>(h), 1)) return std::nullopt;
    return end;
  }

  /// Checks that the states move noticeably. If the steps were tiny compared with the time scale of the motion, every
  /// method would be exact to rounding.
  void check_motion() const {
    constexpr double least = 0.02;  // in units of q and p
    double most = 0;
    for (const auto& z : around_.states) {
      for (const double part : {1.0, 0.25}) {
        const auto end = exact(z, part * 20 * short_step_);
        if (!end) continue;
        for (std::size_t i = 0; i < size(); ++i) {
          const double moved = static_cast<double>((*end)[i] - static_cast<long double>(z[i])) / around_.unit[i];
          if (std::isfinite(moved)) most = std::max(most, std::abs(moved));
        }
      }
    }
    if (most >= least) return;
    throw Error(
        fmt::format("the longest step, h = {:.2g}, moves the state by {:.1e} of its size; allowed {} or more; give a "
                    "state that moves, "
                    "e.g. by problem.at(q=..., p=...)",
                    20 * short_step_, most, least));
  }

  std::size_t size() const { return around_.unit.size(); }
  std::size_t degrees() const { return size() / 2; }

  /// Returns the state after a step. @throws Error if the step fails
  State<double> stepped(const State<double>& z, double h) {
    const auto half = z.begin() + static_cast<std::ptrdiff_t>(degrees());
    std::vector<double> q(z.begin(), half);
    std::vector<double> p(half, z.end());
    step_(q, p, h);
    if (q.size() != degrees() || p.size() != degrees()) {
      throw Error(
          fmt::format("the step returned {} and {} numbers; allowed {} of each", q.size(), p.size(), degrees()));
    }
    q.insert(q.end(), p.begin(), p.end());
    for (const double x : q) {
      if (!std::isfinite(x))
        throw Error(fmt::format("the step returned {} with h = {:.6g}; allowed finite numbers", x, h));
      is_single_precision_ = is_single_precision_ && static_cast<double>(static_cast<float>(x)) == x;
    }
    return q;
  }
  /// The same, but nullopt if the step fails, as it may with a large h.
  std::optional<State<double>> tried(const State<double>& z, double h) {
    try {
      return stepped(z, h);
    } catch (const Error& error) {
      failure_ = error.what();
      return std::nullopt;
    }
  }

  /// Returns the error of a step in units of the state; nullopt if the step fails.
  std::optional<State<double>> error_of(const State<double>& z, double h) {
    const auto end = tried(z, h);
    if (!end) return std::nullopt;
    const auto right = exact(z, h);
    if (!right) return std::nullopt;
    State<double> error(size());
    for (std::size_t i = 0; i < size(); ++i) {
      error[i] = static_cast<double>(static_cast<long double>((*end)[i]) - (*right)[i]) / around_.unit[i];
      if (!std::isfinite(error[i])) return std::nullopt;
    }
    return error;
  }
  /// Returns the RMS error over all states; nullopt if a step fails.
  std::optional<double> mean_error(double h) {
    double squares = 0;
    for (const auto& z : around_.states) {
      const auto error = error_of(z, h);
      if (!error) return std::nullopt;
      squares += std::pow(size_of(*error), 2);
    }
    return std::sqrt(squares / static_cast<double>(around_.states.size()));
  }

  std::vector<std::string> names() const {
    std::vector<std::string> all{energy_name};
    for (const InvariantInfo& info : problem_.entry->info.invariants) all.push_back(info.name);
    return all;
  }
  void check_names() const {
    const std::vector<std::string> known = names();
    for (const std::string& claim : claims_.preserves) {
      if (std::find(known.begin(), known.end(), claim) != known.end()) continue;
      throw Error("preserves: found " + claim + "; allowed " + joined(known) + suggestion(claim, known));
    }
  }

  /// Makes the same call twice, with another one in between. @throws Error if a step fails here
  void check_repeatable() {
    const State<double>& z = around_.states[0];
    const auto begin = std::chrono::steady_clock::now();
    first_ = stepped(z, short_step_);
    (void)stepped(around_.states[1 % around_.states.size()], 1.5 * short_step_);
    check_repeated();
    const std::chrono::duration<double> taken = (std::chrono::steady_clock::now() - begin) / 3;
    if (first_ == z) {
      throw Error(
          fmt::format("the step changed nothing with h = {:.3g}; allowed a step that returns the new (q, p), or "
                      "changes its arguments in place",
                      short_step_));
    }
    // The measurements make about 2000 calls from four states. A slow step is measured from fewer states.
    constexpr double slow = 3e-3;
    if (taken.count() > slow) around_.states.resize(std::min<std::size_t>(around_.states.size(), 2));
    if (taken.count() > 3 * slow) around_.states.resize(1);
  }
  void check_repeated() {
    const State<double> again = stepped(around_.states[0], short_step_);
    if (std::memcmp(again.data(), first_.data(), first_.size() * sizeof(double)) == 0) return;
    throw Error(
        "the step has hidden state: the same (q, p, h) gave different results; allowed a step that depends only on its "
        "arguments");
  }

  /// The error of a step, and the fraction of it that is not a smooth function of h.
  struct OrderPoint {
    double h = 0;
    double error = 0;
    double noise = 0;
  };
  /// nullopt if a step fails.
  std::optional<OrderPoint> order_point(double h) {
    constexpr double nearby = 0x1p-10;  // relative to h
    double squares = 0;
    double second_differences = 0;
    for (const auto& z : around_.states) {
      const auto here = error_of(z, h);
      const auto below = here ? error_of(z, h * (1 - nearby)) : std::nullopt;
      const auto above = below ? error_of(z, h * (1 + nearby)) : std::nullopt;
      if (!above) return std::nullopt;
      squares += std::pow(size_of(*here), 2);
      for (std::size_t i = 0; i < size(); ++i) {
        // 1 + 4 + 1, the squares of the weights
        second_differences += std::pow((*below)[i] - 2 * (*here)[i] + (*above)[i], 2) / 6;
      }
    }
    const double count = static_cast<double>(around_.states.size());
    return OrderPoint{h, std::sqrt(squares / count), squares > 0 ? std::sqrt(second_differences / squares) : 1};
  }

  void measure_order() {
    constexpr int most_lengths = 128;
    constexpr std::size_t enough = 24;
    constexpr double rounding_in_single_precision = 0x1p-17;
    constexpr int gone = 8;  // stops after this many noisy errors in succession, over a factor of 4 in h
    std::vector<OrderPoint> points;
    double largest_error = 0;
    int noisy = 0;
    for (int k = 0; k < most_lengths && noisy < gone; ++k) {
      const auto point = order_point(20 * short_step_ * std::exp2(-0.25 * k));
      if (!point || !(point->error < most_error)) continue;
      if (is_single_precision_ && point->error < rounding_in_single_precision) break;
      largest_error = std::max(largest_error, point->error);
      noisy = point->noise > smooth ? noisy + 1 : 0;
      if (noisy == 0) points.push_back(*point);
      if (point->error < rounding_of_scaled_state && points.size() >= enough) break;
    }
    fit_order(points, largest_error);
  }

  /// Fit of log E = a + s log h + b h^k + c h^l, by least squares.
  struct PowerFit {
    double order = 0;
    double uncertainty = 0;
    double misfit = std::numeric_limits<double>::infinity();  // RMS residual in units of the noise
  };
  static PowerFit fitted_power(std::span<const OrderPoint> points, const std::vector<int>& powers) {
    constexpr double least_noise = 1e-3;  // part of log E that the omitted terms may explain
    std::vector<std::vector<double>> columns;
    const auto add = [&](const auto& value) {
      std::vector<double> column;
      for (const OrderPoint& each : points) column.push_back(value(each) / std::max(each.noise, least_noise));
      columns.push_back(std::move(column));
    };
    add([](const OrderPoint&) { return 1.0; });
    for (const int power : powers) add([&](const OrderPoint& each) { return std::pow(each.h / points[0].h, power); });
    add([](const OrderPoint& each) { return std::log(each.h); });
    add([](const OrderPoint& each) { return std::log(each.error); });
    const auto product = [](const std::vector<double>& x, const std::vector<double>& y) {
      double sum = 0;
      for (std::size_t i = 0; i < x.size(); ++i) sum += x[i] * y[i];
      return sum;
    };
    // Each column is made orthogonal to the ones before it. The exponent is the slope of the remaining log E over the
    // remaining log h.
    for (std::size_t k = 0; k + 2 < columns.size(); ++k) {
      for (std::size_t l = k + 1; l < columns.size(); ++l) {
        const double along = product(columns[k], columns[l]) / product(columns[k], columns[k]);
        for (std::size_t i = 0; i < points.size(); ++i) columns[l][i] -= along * columns[k][i];
      }
    }
    const std::vector<double>& log_h = columns[columns.size() - 2];
    std::vector<double> rest = columns.back();
    const double exponent = product(log_h, rest) / product(log_h, log_h);
    for (std::size_t i = 0; i < rest.size(); ++i) rest[i] -= exponent * log_h[i];
    const double degrees_left = static_cast<double>(points.size()) - static_cast<double>(powers.size()) - 2;
    return {exponent - 1, 1 / std::sqrt(product(log_h, log_h)), std::sqrt(product(rest, rest) / degrees_left)};
  }

  /// Finds the smallest step sizes at which the error is a power of h, with up to two more terms. Errors below 10^-12
  /// are tried last, because there the rounding of published coefficients with 12 digits shows.
  void fit_order(const std::vector<OrderPoint>& points, double largest_error) {
    constexpr std::size_t fewest = 6;
    constexpr std::size_t most_ends = 6;
    constexpr double most_uncertainty = 0.1;
    if (points.size() < fewest) {
      if (points.empty() && largest_error > 0 && largest_error < exact_to_rounding) {
        found_.order = std::numeric_limits<double>::infinity();
        reasons_.push_back("order: every step is exact to rounding");
        return;
      }
      reasons_.push_back(fmt::format(
          "order undecided: {} of the step sizes give an error that is a smooth function of h and below the "
          "size of the state; a slope needs {}{}",
          points.size(), fewest, failure_.empty() ? "" : "; " + failure_));
      return;
    }
    std::vector<std::size_t> ends;
    for (std::size_t end = points.size(); end >= fewest && ends.size() < most_ends; --end) {
      if (points[end - 1].error >= rounding_of_scaled_state) ends.push_back(end);
    }
    for (std::size_t end = fewest; end <= points.size(); ++end) {
      if (points[end - 1].error < rounding_of_scaled_state) ends.push_back(end);
    }
    PowerFit best;
    for (const std::size_t end : ends) {
      for (const std::size_t count : {12U, 9U, 7U, 6U}) {
        if (count > end) continue;
        const std::span window = std::span(points).subspan(end - count, count);
        for (const std::vector<int>& powers : {std::vector<int>{}, {1}, {2}, {1, 2}}) {
          if (count < powers.size() + 5 && !powers.empty()) continue;
          const PowerFit fit = fitted_power(window, powers);
          if (fit.misfit < best.misfit) best = fit;
          if (fit.misfit > 1 || fit.uncertainty > most_uncertainty) continue;
          found_.order = fit.order;
          return;
        }
      }
    }
    found_.order = best.order;
    is_power_ = false;
    reasons_.push_back(
        fmt::format("order undecided: the errors grow about like h^{:.1f}, but are not a power of h", best.order + 1));
  }

  /// Directions in units of the state: all axes, or a few random directions for a large problem.
  std::vector<State<double>> directions() const {
    constexpr std::size_t most_directions = 6;
    std::vector<State<double>> all;
    if (size() <= most_directions) {
      for (std::size_t i = 0; i < size(); ++i) {
        all.emplace_back(size());
        all.back()[i] = 1;
      }
      return all;
    }
    for (std::size_t k = 0; k < most_directions; ++k) {
      State<double> u;
      for (std::size_t i = 0; i < size(); ++i) u.push_back(counter_uniform(state_seed + 3, k * size() + i));
      const double length = size_of(u);
      for (double& x : u) x /= length;
      all.push_back(std::move(u));
    }
    return all;
  }

  /// Returns the derivative of a step along u; nullopt if a step fails.
  std::optional<Derivative> derivative(const State<double>& z, const State<double>& u, double h) {
    constexpr double lengths[] = {0x1p-7, 0x1p-8, 0x1p-9};
    constexpr double weights[] = {45.0 / 60, -9.0 / 60, 1.0 / 60};
    std::vector<State<double>> found;
    for (const double d : lengths) {
      State<double> sum(size());
      for (int k = 1; k <= 3; ++k) {
        State<double> above = z;
        State<double> below = z;
        for (std::size_t i = 0; i < size(); ++i) {
          above[i] += k * d * u[i] * around_.unit[i];
          below[i] -= k * d * u[i] * around_.unit[i];
        }
        const auto a = tried(above, h);
        const auto b = a ? tried(below, h) : std::nullopt;
        if (!b) return std::nullopt;
        for (std::size_t i = 0; i < size(); ++i) sum[i] += weights[k - 1] * ((*a)[i] - (*b)[i]) / (d * around_.unit[i]);
      }
      found.push_back(std::move(sum));
    }
    Derivative best;
    best.uncertainty = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k + 1 < found.size(); ++k) {
      double apart = 0;
      for (std::size_t i = 0; i < size(); ++i) apart = std::max(apart, std::abs(found[k + 1][i] - found[k][i]));
      if (apart < best.uncertainty) best = {found[k + 1], apart};
    }
    return best;
  }

  double form(const State<double>& x, const State<double>& y) const {
    double sum = 0;
    for (std::size_t i = 0; i < degrees(); ++i) sum += x[i] * y[degrees() + i] - x[degrees() + i] * y[i];
    return sum;
  }

  static StepDefect blank_vote(const OrderPoint& at) {
    return {.h = at.h, .rounding = rounding_of_scaled_state, .error = at.error, .noise = at.noise};
  }

  std::optional<StepDefect> symplectic_vote(const OrderPoint& at) {
    constexpr std::size_t most_states = 3;
    StepDefect vote = blank_vote(at);
    const auto along = directions();
    for (std::size_t k = 0; k < std::min(most_states, around_.states.size()); ++k) {
      std::vector<State<double>> images;
      for (const auto& u : along) {
        const auto image = derivative(around_.states[k], u, at.h);
        if (!image) return std::nullopt;
        vote.rounding = std::max(vote.rounding, image->uncertainty);
        images.push_back(image->value);
      }
      for (std::size_t a = 0; a < along.size(); ++a) {
        for (std::size_t b = 0; b < a; ++b) {
          const double terms = 1 + size_of(images[a]) + size_of(images[b]);
          vote.defect = std::max(vote.defect, std::abs(form(images[a], images[b]) - form(along[a], along[b])) / terms);
        }
      }
    }
    return vote;
  }

  std::optional<StepDefect> symmetric_vote(const OrderPoint& at) {
    StepDefect vote = blank_vote(at);
    for (const auto& z : around_.states) {
      const auto there = tried(z, at.h);
      const auto back = there ? tried(*there, -at.h) : std::nullopt;
      if (!back) return std::nullopt;
      State<double> apart(size());
      for (std::size_t i = 0; i < size(); ++i) apart[i] = ((*back)[i] - z[i]) / around_.unit[i];
      vote.defect = std::max(vote.defect, size_of(apart));
    }
    return vote;
  }

  /// Returns the energy and the components of all invariants at a state.
  /// @param t the time, which the centre of mass depends on
  std::vector<std::vector<double>> kept_at(const State<double>& z, double t = 0) const {
    const auto half = z.begin() + static_cast<std::ptrdiff_t>(degrees());
    const std::vector<double> q(z.begin(), half);
    const std::vector<double> p(half, z.end());
    std::vector<std::vector<double>> all{{problem_.entry->energy(problem_.parameters, q, p)}};
    if (problem_.entry->info.invariants.empty()) return all;
    Request request{.problem = problem_.entry->info.name,
                    .variant = problem_.variant,
                    .parameters = problem_.parameters,
                    .start = {},
                    .method = {.name = "rk4", .options = {}}};
    request.record = false;
    for (const double x : q) request.start.q.push_back(shortest(x));
    for (const double x : p) request.start.p.push_back(shortest(x));
    for (const InvariantExcursion& each : make_simulation(request)->invariants()) all.push_back(each.initial);
    const std::vector<InvariantInfo>& infos = problem_.entry->info.invariants;
    const auto of_kind = [&](Terms terms) {
      return std::find_if(infos.begin(), infos.end(), [&](const InvariantInfo& info) { return info.terms == terms; });
    };
    const auto centre = of_kind(Terms::centre_of_mass);
    const auto momentum = of_kind(Terms::momenta);
    if (centre != infos.end() && momentum != infos.end() && problem_.entry->total_mass) {
      const double mass = problem_.entry->total_mass(problem_.parameters, degrees());
      std::vector<double>& place = all[1 + static_cast<std::size_t>(centre - infos.begin())];
      const std::vector<double>& total = all[1 + static_cast<std::size_t>(momentum - infos.begin())];
      for (std::size_t c = 0; c < place.size(); ++c) place[c] -= total[c] / mass * t;
    }
    return all;
  }
  /// Returns how much each of them changes when the numbers of a state change by one unit.
  std::vector<double> sizes_of_kept(const State<double>& z) const {
    constexpr double part = 0x1p-10;
    std::vector<double> sizes;
    for (std::size_t i = 0; i < size(); ++i) {
      State<double> above = z;
      State<double> below = z;
      above[i] += part * around_.unit[i];
      below[i] -= part * around_.unit[i];
      const auto a = kept_at(above);
      const auto b = kept_at(below);
      sizes.resize(a.size());
      for (std::size_t k = 0; k < a.size(); ++k) {
        double most = 0;
        for (std::size_t c = 0; c < a[k].size(); ++c) most = std::max(most, std::abs(a[k][c] - b[k][c]) / (2 * part));
        sizes[k] += most;
      }
    }
    return sizes;
  }
  /// Returns one vote for each of names(); nullopt if a step fails.
  std::optional<std::vector<StepDefect>> invariant_votes(const OrderPoint& at) {
    std::vector<StepDefect> votes(names().size(), blank_vote(at));
    for (std::size_t k = 0; k < around_.states.size(); ++k) {
      const State<double>& z = around_.states[k];
      const auto end = tried(z, at.h);
      if (!end) return std::nullopt;
      if (sizes_.size() <= k) sizes_.push_back(sizes_of_kept(z));
      const auto before = kept_at(z);
      const auto after = kept_at(*end, at.h);
      for (std::size_t i = 0; i < votes.size(); ++i) {
        for (std::size_t c = 0; c < before[i].size(); ++c) {
          const double moved = std::abs(after[i][c] - before[i][c]);
          votes[i].defect = std::max(votes[i].defect, sizes_[k][i] > 0 ? moved / sizes_[k][i] : 0);
        }
      }
    }
    return votes;
  }

  void measure_structure() {
    // Step sizes go from a thirtieth of a period, or less if such a step fails, to a whole period. Larger step sizes
    // are used if the smaller ones show too little.
    double h = 2 * short_step_;
    const auto is_sane = [&](double length) {
      const auto error = mean_error(length);
      return error && *error < most_error;
    };
    for (int k = 0; k < 6 && !is_sane(h); ++k) h /= 2;
    std::vector<StepDefect> symplectic;
    std::vector<StepDefect> symmetric;
    std::vector<std::vector<StepDefect>> kept(names().size());
    const auto is_done = [](const std::vector<StepDefect>& votes) {
      return std::any_of(votes.begin(), votes.end(), [](const StepDefect& vote) { return vote.is_violated(); }) ||
             std::count_if(votes.begin(), votes.end(), [](const StepDefect& vote) { return vote.is_decided(); }) >= 2;
    };
    std::string no_reversed_step;
    for (int k = 0; k < 6; ++k, h *= 2) {
      const auto at = order_point(h);
      if (!at || !(at->error < most_error)) break;
      bool go_on = false;
      if (!is_done(symplectic)) {
        const auto vote = symplectic_vote(*at);
        if (vote) add(symplectic, *vote);
        go_on = !is_done(symplectic);
      }
      if (!is_done(symmetric) && no_reversed_step.empty()) {
        const auto vote = symmetric_vote(*at);
        if (vote) add(symmetric, *vote);
        if (!vote) no_reversed_step = failure_;
        go_on = go_on || !is_done(symmetric);
      }
      if (const auto votes = invariant_votes(*at)) {
        for (std::size_t i = 0; i < kept.size(); ++i) {
          if (is_done(kept[i])) continue;
          add(kept[i], (*votes)[i]);
          go_on = go_on || !is_done(kept[i]);
        }
      }
      if (!go_on) break;
    }
    const auto decide = [&](const std::vector<StepDefect>& votes, const std::string& property) {
      const PropertyVerdict verdict = verdict_of(votes, property);
      if (!verdict.reason.empty()) reasons_.push_back(verdict.reason);
      return verdict.holds;
    };
    found_.symplectic = decide(symplectic, "symplectic");
    if (no_reversed_step.empty()) {
      found_.symmetric = decide(symmetric, "symmetric");
    } else {
      reasons_.push_back("symmetric undecided: the step fails with a negative h: " + no_reversed_step);
    }
    const std::vector<std::string> all = names();
    for (std::size_t i = 0; i < all.size(); ++i) found_.preserves.emplace_back(all[i], decide(kept[i], all[i]));
  }
  /// Steps whose error is at rounding level are dropped, unless all steps are.
  static void add(std::vector<StepDefect>& votes, const StepDefect& vote) {
    if (vote.is_decided()) std::erase_if(votes, [](const StepDefect& before) { return !before.is_decided(); });
    votes.push_back(vote);
  }

  bool is_linear() {
    const State<double>& z = around_.states[0];
    const double here = frequency_at(problem_, z);
    return std::all_of(around_.states.begin(), around_.states.end(), [&](const State<double>& other) {
      return std::abs(frequency_at(problem_, other) - here) < 1e-6 * here;
    });
  }

  void compare() {
    bool undecided = false;
    std::vector<std::string> refuted;
    const auto compare_one = [&](const std::string& property, const std::optional<bool>& claim,
                                 const std::optional<bool>& found) {
      if (!claim) return;
      undecided = undecided || !found;
      if (!found || *found == *claim) return;
      if (*claim) {
        refuted.push_back(property + " is claimed, but does not hold");
      } else if (degrees() > 1 && !is_linear()) {
        refuted.push_back(property + " is denied, but holds on this problem");
      } else if (!is_linear()) {
        undecided = true;
        reasons_.push_back(property + " is denied, but holds, which may be due to the single degree of freedom");
      }
    };
    if (claims_.order) {
      const double claimed = *claims_.order;
      // The measured order agrees with the nearest whole number. For high orders only few errors are above rounding,
      // and other terms contribute to them.
      const double tolerance = *claims_.order <= 6 ? 0.5 : 1;
      if (!found_.order || !is_power_ || std::isinf(*found_.order)) {
        undecided = true;
      } else if (*found_.order < claimed - tolerance) {
        refuted.push_back(fmt::format("order {} is claimed, but {:.2f} is measured", *claims_.order, *found_.order));
      } else if (*found_.order > claimed + tolerance && !is_linear()) {
        const std::string higher =
            fmt::format("order {} is claimed, but the higher order {:.2f} is measured", *claims_.order, *found_.order);
        if (degrees() > 1) {
          refuted.push_back(higher);
        } else {
          undecided = true;
          reasons_.push_back(higher + ", which may be due to the single degree of freedom");
        }
      }
    }
    compare_one("symplectic", claims_.symplectic, found_.symplectic);
    compare_one("symmetric", claims_.symmetric, found_.symmetric);
    for (const std::string& claim : claims_.preserves) {
      for (const auto& [name, holds] : found_.preserves) {
        if (name == claim) compare_one(name, true, holds);
      }
    }
    reasons_.insert(reasons_.begin(), refuted.begin(), refuted.end());
    found_.agrees = !refuted.empty() ? std::optional<bool>(false)
                    : undecided      ? std::nullopt
                                     : std::optional<bool>(true);
  }

  const ForeignStep& step_;
  const StepProblem& problem_;
  const StepClaims& claims_;
  StepTestStates around_;
  std::unique_ptr<StepMap> flow_;
  double short_step_ = 0;  // a sixtieth of the shortest period
  State<double> first_;
  std::vector<std::vector<double>> sizes_;
  bool is_single_precision_ = true;
  bool is_power_ = true;
  std::string failure_;
  std::vector<std::string> reasons_;
  StepCertificate found_;
};

}  // namespace

StepCertificate certify_step(const ForeignStep& step, const StepProblem& problem, const StepClaims& claims) {
  if (problem.entry->walls) throw Error("found a problem with walls; allowed a problem without walls");
  if (problem.entry->onto_constraints) {
    throw Error("found a problem with constraints; allowed a problem without constraints");
  }
  return StepExamination(step, problem, claims).certificate();
}

}  // namespace hamflow
