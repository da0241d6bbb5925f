#include "family_loop.hpp"

#include <algorithm>
#include <bit>

namespace hamflow {

namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// Whether two steps differ only in constants.
bool alike(const RecordedStep& a, const RecordedStep& b) {
  const auto same_field = [](const CarriedField& x, const CarriedField& y) {
    return x.kind == y.kind && (x.kind == CarriedField::Kind::kept || x.bits == y.bits);  // a kept number depends on h
  };
  return a.program.operations == b.program.operations && a.program.outputs == b.program.outputs &&
         a.program.checks == b.program.checks && a.program.ends_at == b.program.ends_at && a.words == b.words &&
         a.program.constants.size() == b.program.constants.size() &&
         std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), b.fields.end(), same_field);
}

}  // namespace

bool FamilyLoop::load(const Steps& steps, const Make& make) {
  const RecordedStep& first = *steps[0];
  std::vector<bool> differ(first.program.constants.size());
  for (std::size_t i = 1; i < steps.size(); ++i) {
    if (steps[i] == steps[i - 1]) continue;
    if (!alike(first, *steps[i])) return false;
    for (std::size_t k = 0; k < differ.size(); ++k) {
      if (!same_bits(steps[i]->program.constants[k], first.program.constants[k])) differ[k] = true;
    }
  }
  const bool known = loop_ && alike(*first_, first);
  if (!known || !serves(first.program, differ)) {
    if (known) {  // constants that differed once are likely to differ again
      for (std::size_t k = 0; k < differ.size(); ++k) {
        differ[k] = differ[k] || differs_[k] || !same_bits(first_->program.constants[k], first.program.constants[k]);
      }
    }
    first_ = steps[0];
    differs_ = differ;
    if (!make_loop(first.program, make)) return false;
  }
  constants_ = constants(steps);
  return true;
}

/// Whether the loop can be used for a block: its members differ in the same constants, or in fewer.
bool FamilyLoop::serves(const Program& program, const std::vector<bool>& differ) const {
  for (std::size_t k = 0; k < differ.size(); ++k) {
    if (!differs_[k] && (differ[k] || !same_bits(first_->program.constants[k], program.constants[k]))) return false;
  }
  return true;
}

bool FamilyLoop::make_loop(const Program& program, const Make& make) {
  loop_ = nullptr;
  lanes_ = 0;
  const std::optional<Program> made = make ? make(program) : program;
  if (!made) return false;
  const auto flags = std::make_unique<bool[]>(made->constants.size());
  std::copy(differs_.begin(), differs_.end(), flags.get());
  loop_ = make_lane_loop(*made, {flags.get(), made->constants.size()}, set_, registers_);
  lanes_ = loop_->lanes();
  return true;
}

LaneNumbers FamilyLoop::constants(const Steps& steps) const {
  std::vector<double> constants;
  for (std::size_t k = 0; k < differs_.size(); ++k) {
    if (!differs_[k]) continue;
    for (std::size_t lane = 0; lane < lanes(); ++lane) {
      constants.push_back(steps[std::min(lane, steps.size() - 1)]->program.constants[k]);
    }
  }
  return loop_->prepared(constants);
}

}  // namespace hamflow
