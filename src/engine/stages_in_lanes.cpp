#include "stages_in_lanes.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "element_programs.hpp"
#include "hamflow/detail/core/pool.hpp"
#include "hamflow/detail/methods/implicit/averages_rows.hpp"
#include "recorded_step.hpp"

namespace hamflow {

namespace {

using Number = Trace<double>;
using Numbers = Vector<Number, dynamic>;

constexpr double epsilon = std::numeric_limits<double>::epsilon();
constexpr std::size_t most_lanes = 32;
/// Below this bound the scaled norm was not divided by a zero or subnormal scale.
constexpr double most_plain_size = 0x1p51;

/// A value of one lane.
struct OfLane {
  std::size_t value;
  std::size_t lane;
};

/// Changes a program so that its values after the first `values` are read from single lanes.
Program with_lanes(const Program& program, std::size_t values, std::span<const OfLane> from) {
  Program all;
  all.constants = program.constants;
  std::vector<Operand> results;
  std::vector<Operand> read(from.size());
  const auto place = [&](const Operand& operand) -> Operand {
    if (operand.kind == Operand::Kind::result) return results[operand.index];
    if (operand.kind != Operand::Kind::carried || operand.index < values) return operand;
    Operand& found = read[operand.index - values];
    if (found.kind == Operand::Kind::none) {
      const auto [value, lane] = from[operand.index - values];
      all.constants.push_back(static_cast<double>(lane));
      all.operations.push_back({Instruction::of_lane,
                                {Operand::Kind::carried, static_cast<std::uint32_t>(value)},
                                {Operand::Kind::constant, static_cast<std::uint32_t>(all.constants.size() - 1)}});
      found = {Operand::Kind::result, static_cast<std::uint32_t>(all.operations.size() - 1)};
    }
    return found;
  };
  for (const auto& [instruction, a, b, c] : program.operations) {
    const Operand x = place(a);
    const Operand y = place(b);
    const Operand z = place(c);
    all.operations.push_back({instruction, x, y, z});
    results.push_back({Operand::Kind::result, static_cast<std::uint32_t>(all.operations.size() - 1)});
  }
  for (std::size_t k = 0; k < values; ++k) all.outputs.push_back(place(program.outputs[k]));
  for (const auto& check : program.checks) {
    const Operand x = place(check.a);
    all.checks.push_back({check.kind, x, place(check.b)});
  }
  return all;
}

}  // namespace

/// The recording of one program.
class StagesInLanes::Recording {
 public:
  /// @param values the values of one lane   @param wanted the values that are read from other lanes
  Recording(const std::vector<double>& values, std::vector<OfLane> wanted)
      : recorder_(Folding::exact, most_recorded_operations), wanted_(std::move(wanted)) {
    for (const double value : values) numbers.push_back(recorder_.input(value));
    for (const OfLane& of : wanted_) others_.push_back(recorder_.input(values[of.value]));
  }
  /// Returns a value of another lane, which has to be one of `wanted`.
  const Number& of(std::size_t value, std::size_t lane = 0) const {
    const auto found = std::find_if(wanted_.begin(), wanted_.end(),
                                    [&](const OfLane& one) { return one.value == value && one.lane == lane; });
    return others_[static_cast<std::size_t>(found - wanted_.begin())];
  }
  std::shared_ptr<const LaneLoop> loop(LaneSet lanes, std::size_t registers) {
    std::vector<Number> outputs = numbers;
    outputs.insert(outputs.end(), others_.begin(), others_.end());
    const Program program = with_lanes(program_of(recorder_.finish(outputs)), numbers.size(), wanted_);
    const auto differs = std::make_unique<bool[]>(program.constants.size());
    return make_lane_loop(program, {differs.get(), program.constants.size()}, lanes, registers, StepsOfLoop::one);
  }

  std::vector<Number> numbers;

 private:
  Recorder<double> recorder_;
  std::vector<OfLane> wanted_;
  std::vector<Number> others_;
};

std::optional<StagesInLanes> StagesInLanes::recorded(const Traced& problem, const AverageTable<double>& table,
                                                     std::span<const double> q, std::span<const double> p,
                                                     LaneSet lanes) {
  StagesInLanes all;
  const auto k = static_cast<std::size_t>(table.points);
  const std::size_t n = q.size();
  all.at_ = {n, k};
  const Layout& at = all.at_;
  const std::size_t in_register = lanes == LaneSet::avx512 ? 8 : 4;
  const std::size_t registers = (k + in_register - 1) / in_register;
  all.scale_ = table.scale;

  std::vector<double> values(at.size());  // the values for a step of length 0
  std::copy(q.begin(), q.end(), values.begin() + Layout::q0);
  std::copy(p.begin(), p.end(), values.begin() + static_cast<std::ptrdiff_t>(at.p0()));
  const auto stages_of = [&](std::size_t first) {
    std::vector<OfLane> wanted;
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t i = 0; i < k; ++i) wanted.push_back({first + a, i});
    }
    return wanted;
  };
  const auto first_lane_of = [&](std::vector<OfLane>& wanted, std::size_t first, std::size_t count) {
    for (std::size_t a = 0; a < count; ++a) wanted.push_back({first + a, 0});
  };
  // Corresponds to add_half_increment with e = 1.
  const auto middle = [&](const Recording& r, std::size_t from, std::size_t stages, std::size_t a) {
    Number sum(0);
    for (std::size_t j = 0; j < k; ++j) sum += r.of(stages + a, j);
    return r.of(from + a) + sum / Number(2);
  };
  try {
    {  // corresponds to NaturalAverages::displacements
      auto wanted = stages_of(at.x());
      first_lane_of(wanted, at.p0(), n);
      Recording r(values, wanted);
      Numbers momenta(n);
      for (std::size_t a = 0; a < n; ++a) {
        const Number half = middle(r, at.p0(), at.x(), a);
        Number row(0);
        for (std::size_t i = 0; i < k; ++i) row -= r.numbers[at.coupling() + i] * r.of(at.x() + a, i);
        momenta[a] = row + half;
      }
      Numbers v = momenta;
      velocity(problem, momenta, v);
      for (std::size_t a = 0; a < n; ++a) r.numbers[at.u() + a] = r.numbers[at.reach()] * v[a];
      all.displace_ = r.loop(lanes, registers);
    }
    {  // corresponds to NaturalAverages::evaluate, and computes the correction
      auto wanted = stages_of(at.u());
      first_lane_of(wanted, Layout::unit, 2);
      first_lane_of(wanted, at.q0, n);
      Recording r(values, wanted);
      Numbers point(n);
      for (std::size_t a = 0; a < n; ++a) {
        const Number half = middle(r, at.q0, at.u(), a);
        Number sum = r.numbers[at.inner()] * r.of(at.u() + a, 0);
        for (std::size_t j = 1; j < k; ++j) sum += r.numbers[at.inner() + j] * r.of(at.u() + a, j);
        point[a] = half + sum;
      }
      Numbers f = point;
      force(problem, point, f);
      const Number& unit = r.of(Layout::unit);
      const Number& length = r.of(Layout::length);
      Number largest(0);
      for (std::size_t a = 0; a < n; ++a) {
        Number& x = r.numbers[at.x() + a];
        const Number sum = r.numbers[at.unit_weight()] * f[a];
        const Number noise = r.numbers[at.weight()] * (length * abs(f[a]));
        const Number target = unit * sum;
        const Number error = product_error(unit, sum, target);
        const Number correction = (target - x) + error;
        r.numbers[at.correction() + a] = correction;
        const Number unit_of_correction = Number(epsilon) * (noise + abs(x));
        r.numbers[at.noise() + a] = noise;
        r.numbers[at.unit_of() + a] = unit_of_correction;
        const Number size = abs(correction) / larger(unit_of_correction, Number(std::numeric_limits<double>::min()));
        largest = a == 0 ? size : larger(largest, size);
        r.numbers[at.at_end() + a] = target + (error + Number(0));
        x = x + correction;
      }
      r.numbers[at.sizes()] = largest;
      all.evaluate_ = r.loop(lanes, registers);
    }
    {  // corresponds to NaturalAverages::increment_of without the sums over the stages, and to detail::continued
      auto wanted = stages_of(at.at_end());
      first_lane_of(wanted, at.p0(), n);
      Recording r(values, wanted);
      Numbers high(n);
      Numbers low(n);
      for (std::size_t a = 0; a < n; ++a) {
        detail::CompensatedSum<Number> sum{r.of(at.p0() + a), Number(0)};
        Number next(0);
        for (std::size_t i = 0; i < k; ++i) {
          sum.add(r.numbers[at.factor() + i] * r.of(at.at_end() + a, i));
          next += r.numbers[at.continuing() + i] * r.of(at.at_end() + a, i);
        }
        r.numbers[at.next() + a] = next;
        high[a] = sum.high;
        low[a] = sum.low;
      }
      Numbers v = high;
      Numbers rest = high;
      velocity(problem, high, v);
      velocity(problem, low, rest);
      const Number& reach = r.numbers[at.reach()];
      for (std::size_t a = 0; a < n; ++a) {
        const Number d = reach * v[a];
        r.numbers[at.d() + a] = d;
        r.numbers[at.lost() + a] = product_error(reach, v[a], d) + reach * rest[a];
      }
      all.finish_ = r.loop(lanes, registers);
    }
  } catch (const CannotRecord&) {
    return std::nullopt;
  }
  all.width_ = all.evaluate_->lanes();
  if (all.width_ > most_lanes) return std::nullopt;
  all.numbers_.assign(at.size() * all.width_, 0);
  all.no_constants_ = all.evaluate_->prepared({});
  for (std::size_t l = 0; l < k; ++l) {  // lanes without a stage have coefficients 0
    all.row(at.weight())[l] = table.weight[l * k + l];
    all.row(at.unit_weight())[l] = table.unit_weight[l * k + l];
    for (std::size_t j = 0; j < k; ++j) {
      all.row(at.coupling() + j)[l] = table.coupling[j * k + l];
      all.row(at.inner() + j)[l] = table.inner[j * k + l];
      all.row(at.continuing() + j)[l] = table.next[j * k + l];
      all.row(at.factor() + j)[l] = table.increment[j] / 2 + table.coupling[l * k + j];
    }
  }
  return all;
}

void StagesInLanes::begin(double h, std::span<const double> q, std::span<const double> p, std::span<const double> x) {
  row(Layout::unit)[0] = h / detail::golden_ratio<double>();
  row(Layout::length)[0] = std::abs(h);
  for (std::size_t l = 0; l < at_.k; ++l) row(at_.reach())[l] = h * scale_[l];
  for (std::size_t a = 0; a < at_.n; ++a) {
    row(Layout::q0 + a)[0] = q[a];
    row(at_.p0() + a)[0] = p[a];
    std::copy_n(&x[a * at_.k], at_.k, row(at_.x() + a));
  }
}

bool StagesInLanes::run(const LaneLoop& program) {
  std::array<bool, most_lanes> failed{};
  program.run(numbers_, no_constants_, 1, {failed.data(), width_});
  return std::none_of(failed.begin(), failed.begin() + static_cast<std::ptrdiff_t>(at_.k),
                      [](bool one) { return one; });
}

bool StagesInLanes::correct() {
  if (!run(*displace_) || !run(*evaluate_)) return false;
  size_ = 0;
  for (std::size_t l = 0; l < at_.k; ++l) size_ = larger(size_, row(at_.sizes())[l]);
  if (!(size_ < most_plain_size)) size_ = measured();
  return true;
}

double StagesInLanes::measured() const {
  double largest = 0;
  double total = 0;
  for (std::size_t a = 0; a < at_.n; ++a) {
    for (std::size_t l = 0; l < at_.k; ++l) {
      const double size = std::abs(row(at_.correction() + a)[l]);
      largest = larger_size(largest, in_units_of_noise(size, row(at_.unit_of() + a)[l]));
      total += size;
    }
  }
  return largest + total <= std::numeric_limits<double>::max() ? largest : std::numeric_limits<double>::infinity();
}

double StagesInLanes::distance_of(std::span<const double> other) const {
  double largest = 0;
  for (std::size_t a = 0; a < at_.n; ++a) {
    for (std::size_t l = 0; l < at_.k; ++l) {
      const double x = row(at_.at_end() + a)[l];
      const double unit = epsilon * (row(at_.noise() + a)[l] + std::abs(x));
      largest = larger_size(largest, in_units_of_noise(std::abs(other[a * at_.k + l] - x), unit));
    }
  }
  return largest;
}

bool StagesInLanes::end(std::span<double> x, std::span<double> dq, std::span<double> dp, std::span<double> next) {
  if (!run(*finish_)) return false;
  // Adds the sums for q and for p in the same loop, each as detail::CompensatedSum does.
  for (std::size_t a = 0; a < at_.n; ++a) {
    const double* const impulse = row(at_.at_end() + a);
    const double* const d = row(at_.d() + a);
    const double* const lost = row(at_.lost() + a);
    Two high{};
    Two low{};
    for (std::size_t j = 0; j < at_.k; ++j) {
      const Two increment{d[j], impulse[j]};
      const Two sum = high + increment;
      const Two part = sum - high;
      low += (high - (sum - part)) + (increment - part);
      high = sum;
      low[0] += lost[j];
    }
    dq[a] = high[0] + low[0];
    dp[a] = high[1] + low[1];
    std::copy_n(impulse, at_.k, &x[a * at_.k]);
    std::copy_n(row(at_.next() + a), at_.k, &next[a * at_.k]);
  }
  return true;
}

}  // namespace hamflow
