#include "parts_in_numbers.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace hamflow {

PartsInNumbers::PartsInNumbers(RecordedPart part)
    : each_(part.state / (2 * part.size)), state_(part.state), values_(part.program.values()) {
  auto loop = make_step_loop(part.program);
  compiled_ = std::make_shared<const Compiled>(Compiled{std::move(part), std::move(loop)});
}

double* PartsInNumbers::begin() {
  looks_ = parts_ = 0;
  return state_.data();
}

const double* PartsInNumbers::look(double h) {
  std::copy(state_.begin(), state_.end(), values_.begin());
  values_[part().length()] = h;
  if (!compiled_->loop->run(values_, 1)) return nullptr;
  const double* const end = values_.data() + part().end();
  for (std::size_t i = 0; i < 2 * part().size + 1; ++i) {
    if (!(std::abs(end[i]) <= std::numeric_limits<double>::max())) return nullptr;
  }
  ++looks_;
  return end;
}

void PartsInNumbers::go() {
  std::copy_n(values_.begin(), state_.size(), state_.begin());
  ++parts_;
}

Effort PartsInNumbers::effort() const {
  const Effort& each = part().effort;
  return {.force = looks_ * each.force, .gradient = looks_ * each.gradient, .hessian = looks_ * each.hessian};
}

void PartsInNumbers::negate_momentum(std::size_t i) {
  double* const p = state_.data() + each_ * (part().size + i);
  for (std::size_t k = 0; k < each_; ++k) p[k] = -p[k];
}

}  // namespace hamflow
