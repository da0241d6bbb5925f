#include "hamflow/detail/verify/lyapunov.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>

#include "hamflow/core/counter_random.hpp"
#include "hamflow/core/error.hpp"
#include "hamflow/core/math.hpp"

namespace hamflow {

namespace {

double dot(const State<double>& a, const State<double>& b) {
  double sum = 0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
  return sum;
}

/// Returns generic orthonormal columns of C^n. Real and imaginary part of a column are the q and p of a tangent vector.
/// A unitary matrix is both orthogonal and symplectic, and J is multiplication by -i.
std::vector<std::vector<std::complex<double>>> unitary_columns(std::size_t n, std::size_t count, std::uint64_t seed) {
  std::vector<std::vector<std::complex<double>>> columns(count, std::vector<std::complex<double>>(n));
  std::uint64_t drawn = 0;
  for (std::size_t k = 0; k < count; ++k) {
    for (auto& entry : columns[k]) {
      const double real = counter_uniform(seed, drawn++);
      entry = {real, counter_uniform(seed, drawn++)};
    }
    for (int pass = 0; pass < 2; ++pass) {
      for (std::size_t j = 0; j < k; ++j) {
        std::complex<double> product = 0;
        for (std::size_t i = 0; i < n; ++i) product += std::conj(columns[j][i]) * columns[k][i];
        for (std::size_t i = 0; i < n; ++i) columns[k][i] -= product * columns[j][i];
      }
      double square = 0;
      for (const auto& entry : columns[k]) square += std::norm(entry);
      for (auto& entry : columns[k]) entry /= std::sqrt(square);
    }
  }
  return columns;
}

}  // namespace

TangentFrame::TangentFrame(std::size_t dimension, std::size_t count, std::uint64_t seed) {
  if (count < 1 || count > 2 * dimension) {
    throw Error("found " + std::to_string(count) + " tangent vectors; allowed 1 to " + std::to_string(2 * dimension));
  }
  const auto columns = unitary_columns(dimension, std::min(count, dimension), seed);
  for (std::size_t k = 0; k < count; ++k) {
    const auto& u = columns[k < dimension ? k : 2 * dimension - 1 - k];
    State<double> vector(2 * dimension);
    for (std::size_t i = 0; i < dimension; ++i) {
      vector[i] = k < dimension ? u[i].real() : u[i].imag();  // because J (q, p) = (p, -q)
      vector[dimension + i] = k < dimension ? u[i].imag() : -u[i].real();
    }
    vectors_.push_back(std::move(vector));
  }
}

bool TangentFrame::orthonormalise(std::span<double> logs) {
  for (std::size_t k = 0; k < vectors_.size(); ++k) {
    State<double>& v = vectors_[k];
    for (int pass = 0; pass < (k > 0 ? 2 : 1); ++pass) {  // twice is enough [Parlett1998, Sect. 6.9]
      for (std::size_t j = 0; j < k; ++j) {
        const State<double>& u = vectors_[j];
        const double product = dot(u, v);
        for (std::size_t i = 0; i < v.size(); ++i) v[i] -= product * u[i];
      }
    }
    const double length = std::sqrt(dot(v, v));
    if (!(length > 0 && length <= std::numeric_limits<double>::max())) return false;
    for (double& x : v) x /= length;
    logs[k] = log(length);
  }
  return true;
}

void LyapunovSums::add(std::span<const double> logs, std::int64_t steps) {
  constexpr std::size_t most_blocks = 64;
  for (std::size_t i = 0; i < logs.size(); ++i) {
    total_[i] += logs[i];
    block_[i] += logs[i];
  }
  steps_ += steps;
  block_steps_ += steps;
  ++renormalisations_;
  if (block_steps_ < wanted_steps_) return;
  blocks_.push_back({block_, block_steps_});
  block_.assign(block_.size(), 0);
  block_steps_ = 0;
  if (blocks_.size() < most_blocks) return;
  for (std::size_t k = 0; k < most_blocks / 2; ++k) {
    Block& joined = blocks_[k];
    const Block first = blocks_[2 * k];
    const Block second = blocks_[2 * k + 1];
    joined.steps = first.steps + second.steps;
    for (std::size_t i = 0; i < joined.logs.size(); ++i) joined.logs[i] = first.logs[i] + second.logs[i];
  }
  blocks_.resize(most_blocks / 2);
  wanted_steps_ *= 2;
}

std::vector<double> LyapunovSums::rates(std::size_t i, std::size_t joined, double h) const {
  std::vector<double> all;
  for (std::size_t first = 0; first + joined <= blocks_.size(); first += joined) {
    double logs = 0;
    std::int64_t steps = 0;
    for (std::size_t k = first; k < first + joined; ++k) {
      logs += blocks_[k].logs[i];
      steps += blocks_[k].steps;
    }
    all.push_back(logs / (static_cast<double>(steps) * std::abs(h)));
  }
  return all;
}

namespace {

constexpr std::size_t fewest_blocks = 16;

/// Standard deviation of some numbers.
double spread(const std::vector<double>& xs) {
  double mean = 0;
  for (const double x : xs) mean += x / static_cast<double>(xs.size());
  double sum = 0;
  for (const double x : xs) sum += (x - mean) * (x - mean);
  return std::sqrt(sum / static_cast<double>(xs.size() - 1));
}

struct ErrorOfMean {
  double independent = 0;  // as if the blocks were independent
  double joined = 0;       // the largest error for single, pairs of and groups of four blocks
  double continued = 0;    // extrapolated with the power with which these errors decrease
};

/// Standard error of the mean of correlated blocks.   @param by_level rates of single blocks, of pairs and of groups of
/// four
ErrorOfMean error_of_mean(const std::array<std::vector<double>, 3>& by_level) {
  const auto blocks = static_cast<double>(by_level[0].size());
  ErrorOfMean error;
  std::array<double, 3> logs{};  // log2 of the standard deviations
  std::array<double, 3> weights{};
  for (std::size_t level = 0; level < by_level.size(); ++level) {
    const double s = spread(by_level[level]);
    if (!(s > 0)) return {s, s, s};  // 0 or NaN
    const double of_level = s / std::sqrt(blocks / std::exp2(level));
    if (level == 0) error.independent = of_level;
    error.joined = std::max(error.joined, of_level);
    logs[level] = std::log2(s);
    weights[level] = static_cast<double>(by_level[level].size() - 1);
  }
  // Least-squares line through the three logarithms. Its slope is -1/2 for independent blocks.
  const double sum = weights[0] + weights[1] + weights[2];
  const double x = (weights[1] + 2 * weights[2]) / sum;
  const double y = (weights[0] * logs[0] + weights[1] * logs[1] + weights[2] * logs[2]) / sum;
  double covariance = 0;
  double variance = 0;
  for (std::size_t level = 0; level < logs.size(); ++level) {
    const double from_mean = static_cast<double>(level) - x;
    covariance += weights[level] * from_mean * (logs[level] - y);
    variance += weights[level] * from_mean * from_mean;
  }
  const double slope = std::clamp(covariance / variance, -0.5, 0.0);
  error.continued = std::max(error.joined, std::exp2(y + slope * (std::log2(blocks) - x)));
  return error;
}

}  // namespace

LyapunovSpectrum LyapunovSums::spectrum(std::size_t dimension, double h) const {
  LyapunovSpectrum found;
  found.time = static_cast<double>(steps_) * std::abs(h);
  found.renormalisations = renormalisations_;
  const bool has_blocks = blocks_.size() >= fewest_blocks;
  for (std::size_t i = 0; i < total_.size(); ++i) {
    found.exponents.push_back(total_[i] / found.time);
    if (!has_blocks) {
      found.standard_errors.push_back(std::numeric_limits<double>::quiet_NaN());
      continue;
    }
    const std::vector<double> pairs = rates(i, 2, h);
    const ErrorOfMean error = error_of_mean({rates(i, 1, h), pairs, rates(i, 4, h)});
    found.standard_errors.push_back(error.continued);
    if (i > 0) continue;
    const double enough = found.exponents[0] / 5;
    found.steady = error.joined < 1.5 * error.independent &&
                   std::all_of(pairs.begin(), pairs.end(), [&](double rate) { return rate > 0 && rate >= enough; });
  }
  if (total_.size() == 2 * dimension) {
    for (std::size_t i = 0; i < dimension; ++i) {
      found.pair_sums.push_back((total_[i] + total_[2 * dimension - 1 - i]) / found.time);
    }
  }
  return found;
}

std::int64_t steps_between(std::int64_t present, std::span<const double> logs) {
  constexpr std::int64_t most = 64;
  double largest = 0;
  for (const double x : logs) largest = std::max(largest, std::abs(x) / std::log(2.0));
  if (largest > 6) return std::max<std::int64_t>(present / 2, 1);
  return largest < 2 ? std::min(2 * present, most) : present;
}

namespace {
StepMapSource source_of(std::shared_ptr<const StepMap> map) {
  if (map == nullptr) throw Error("hamflow: there is no map of one step to differentiate");
  return {map->dimension(), [map] { return map; }};
}
}  // namespace

TangentObserver::TangentObserver(std::shared_ptr<const StepMap> map, double h, std::int64_t last_step)
    : TangentObserver(source_of(std::move(map)), h, last_step) {}

TangentObserver::TangentObserver(StepMapSource source, double h, std::int64_t last_step)
    : source_(std::move(source)), h_(h), last_step_(last_step) {}

std::int64_t TangentObserver::next_due(std::int64_t step) const {
  if (!followed_ || step > last_step_) return never;
  return std::max(step, std::min(due_, last_step_));
}

Verdict TangentObserver::observe(const Frame& frame) {
  std::int64_t next = 1;
  if (at_ >= 0 && frame.step < due_ && frame.step != advanced_to_) keep_state_before_end();
  if (at_ >= 0 && frame.step > at_) {
    const std::int64_t steps = frame.step - at_;
    followed_ = frame.step == advanced_to_ || advance(steps);
    next = followed_ ? taken(steps) : 0;
    followed_ = next > 0;
  }
  z_.assign(frame.q.begin(), frame.q.end());  // state of the run itself, bit for bit
  z_.insert(z_.end(), frame.p.begin(), frame.p.end());
  at_ = frame.step;
  due_ = at_ + next;
  return Verdict::go_on;
}

/// Keeps the state before the last observation, because a longer run would not observe at the end of this one.
void TangentObserver::keep_state_before_end() {
  Writer ar;
  fields(ar);
  before_the_end_ = ar.take();
}

bool TangentObserver::advance(std::int64_t steps) {
  if (map_ == nullptr) map_ = source_.map();
  if (map_ == nullptr) throw Error("hamflow: there is no map of one step to differentiate");
  return map_->advance_with_tangents(z_, tangents(), h_, steps);
}

std::optional<TangentsToAdvance> TangentObserver::tangents_to_advance() {
  const std::int64_t next = next_due(at_ + 1);
  if (at_ < 0 || next == never || advanced_to_ == next) return std::nullopt;
  if (next < due_) keep_state_before_end();
  return TangentsToAdvance{&z_, &tangents(), next - at_};
}

void TangentObserver::archive(Writer& ar) {
  if (before_the_end_.empty() && advanced_to_ > at_)
    throw Error("found tangent vectors that were carried ahead of a run");
  if (before_the_end_.empty()) {
    fields(ar);
  } else {
    ar.raw(before_the_end_.data(), before_the_end_.size());
  }
}

void TangentObserver::archive(Reader& ar) {
  const std::size_t count = tangents().size();
  fields(ar);
  before_the_end_.clear();
  advanced_to_ = -1;
  const auto is_whole = [&](const State<double>& v) { return v.size() == 2 * dimension(); };
  const bool begun = at_ >= 0;
  if (tangents().size() != count || !std::all_of(tangents().begin(), tangents().end(), is_whole) ||
      (begun && !is_whole(z_))) {
    throw Error("saved bytes hold the tangent vectors of another run");
  }
}

LyapunovObserver::LyapunovObserver(std::shared_ptr<const StepMap> map, double h, std::int64_t last_step,
                                   std::size_t count)
    : LyapunovObserver(source_of(std::move(map)), h, last_step, count) {}

LyapunovObserver::LyapunovObserver(StepMapSource source, double h, std::int64_t last_step, std::size_t count)
    : TangentObserver(std::move(source), h, last_step),
      frame_(dimension(), count > 0 ? count : 2 * dimension()),
      sums_(frame_.vectors().size()),
      logs_(frame_.vectors().size()) {}

std::int64_t LyapunovObserver::taken(std::int64_t steps) {
  if (!frame_.orthonormalise(logs_)) return 0;
  sums_.add(logs_, steps);
  return block_ = steps_between(block_, logs_);
}

LyapunovSpectrum lyapunov_spectrum(const StepMap& map, State<double> z, double h, std::int64_t steps, std::size_t count,
                                   const LyapunovOptions& options) {
  TangentFrame frame(map.dimension(), count > 0 ? count : 2 * map.dimension(), options.seed);
  LyapunovSums sums(frame.vectors().size());
  std::vector<double> logs(frame.vectors().size());
  std::int64_t block = 1;
  const auto go = [&](std::int64_t length, bool counts) {
    for (std::int64_t done = 0; done < length;) {
      const std::int64_t now = std::min(block, length - done);
      if (!map.advance_with_tangents(z, frame.vectors(), h, now) || !frame.orthonormalise(logs)) {
        throw Error("a step failed on the way to the Lyapunov exponents");
      }
      if (counts) sums.add(logs, now);
      block = steps_between(block, logs);
      done += now;
    }
  };
  go(options.transient, false);
  go(steps, true);
  return sums.spectrum(map.dimension(), h);
}

double largest_lyapunov(const StepMap& map, State<double> z, double h, std::int64_t steps,
                        const LyapunovOptions& options) {
  TangentFrame frame(map.dimension(), 1, options.seed);
  double total = 0;
  double log = 0;
  std::int64_t block = 1;
  for (std::int64_t done = -options.transient; done < steps;) {
    const std::int64_t end = done < 0 ? 0 : steps;
    const std::int64_t now = std::min(block, end - done);
    if (!map.advance_with_tangents(z, frame.vectors(), h, now) || !frame.orthonormalise({&log, 1})) {
      return std::numeric_limits<double>::quiet_NaN();
    }
    if (done >= 0) total += log;
    block = steps_between(block, {&log, 1});
    done += now;
  }
  return total / (static_cast<double>(steps) * std::abs(h));
}

}  // namespace hamflow
