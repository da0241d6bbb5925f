#include "recorded_block.hpp"

#include <algorithm>
#include <bit>
#include <limits>

#include "hamflow/numerics/program_lanes.hpp"
#include "hamflow/run/recorded_step.hpp"

namespace hamflow {

namespace {

bool same_bits(double a, double b) { return std::bit_cast<std::uint64_t>(a) == std::bit_cast<std::uint64_t>(b); }

/// The same but for constants.
bool alike(const RecordedStep& a, const RecordedStep& b) {
  const auto same_field = [](const CarriedField& x, const CarriedField& y) {
    return x.kind == y.kind && (x.kind == CarriedField::Kind::kept || x.bits == y.bits);  // a kept number depends on h
  };
  return a.program.operations == b.program.operations && a.program.outputs == b.program.outputs &&
         a.program.checks == b.program.checks && a.program.constants.size() == b.program.constants.size() &&
         std::equal(a.fields.begin(), a.fields.end(), b.fields.begin(), b.fields.end(), same_field);
}

class RecordedBlock final : public EnsembleBlock {
 public:
  RecordedBlock(const ProblemEntry& problem, Request request, LaneSet lanes)
      : problem_(problem), request_(std::move(request)), set_(lanes) {}

  std::size_t lanes() const override { return loop_ ? loop_->lanes() : 0; }

  bool load(const ParameterShape& shape, std::span<const MemberStart> members) override {
    members_.clear();
    const MemberStart* before = nullptr;
    for (const MemberStart& start : members) {
      Member member;
      member.simulation =
          problem_.simulate_member(request_, parameters_of(shape, start.parameters), start.q, start.p, start.h);
      member.recorded = dynamic_cast<RecordedMember*>(member.simulation.get());
      if (member.recorded == nullptr) return false;
      const bool same_step = before != nullptr && before->parameters == start.parameters && before->h == start.h;
      member.step = same_step ? members_.back().step : member.recorded->recorded_step();
      if (!member.step || (!members_.empty() && !alike(*members_[0].step, *member.step))) return false;
      before = &start;
      members_.push_back(std::move(member));
    }
    find_loop();
    fill();
    return true;
  }

  void advance(std::int64_t steps) override {
    if (steps > 0 && !under_way_) {
      for (Member& member : members_) member.lost = member.simulation->advance(1) != Outcome::done;
      read();
      --steps;
    }
    if (steps == 0) return;
    loop_->run(carried_, constants_, steps, {failed_.get(), lanes()});
    taken_ += steps;
  }

  MemberEnd look(std::size_t lane) const override {
    const Member& member = members_[lane];
    MemberEnd end;
    if (member.lost || failed_[lane]) return end;
    const std::unique_ptr<Simulation> at_end = member.simulation->clone();
    std::vector<double> values(member.step->program.values());
    for (std::size_t k = 0; k < values.size(); ++k) values[k] = carried_[k * lanes() + lane];
    constexpr double most = std::numeric_limits<double>::max();
    end.regular = std::all_of(values.begin(), values.end(), [](double x) { return std::abs(x) <= most; });
    if (under_way_) dynamic_cast<RecordedMember&>(*at_end).take_values(*member.step, values, taken_);
    Frame frame;
    at_end->look(frame);
    end.q = frame.q;
    end.p = frame.p;
    end.energy = at_end->energy();
    end.energy_scale = at_end->energy_scale();
    end.invariants = at_end->invariants();
    end.regular = end.regular && std::abs(end.energy.final) <= most && end.energy.max_error <= most;
    return end;
  }

 private:
  struct Member {
    std::unique_ptr<Simulation> simulation;
    RecordedMember* recorded = nullptr;  // the same
    std::shared_ptr<const RecordedStep> step;
    bool lost = false;
  };

  static Parameters<double> parameters_of(const ParameterShape& shape, const std::vector<double>& numbers) {
    Parameters<double> parameters;
    std::size_t at = 0;
    for (const auto& [name, size] : shape) {
      const auto first = numbers.begin() + static_cast<std::ptrdiff_t>(at);
      parameters.set_list(name, {first, first + static_cast<std::ptrdiff_t>(size)});
      at += size;
    }
    return parameters;
  }

  /// A loop serves every block whose members differ in the same constants, or in fewer.
  void find_loop() {
    const Program& program = members_[0].step->program;
    std::vector<bool> differ(program.constants.size());
    for (const Member& member : members_) {
      if (member.step == members_[0].step) continue;
      for (std::size_t k = 0; k < differ.size(); ++k) {
        if (!same_bits(member.step->program.constants[k], program.constants[k])) differ[k] = true;
      }
    }
    const bool serves = loop_ && alike(*first_, *members_[0].step) && [&] {
      for (std::size_t k = 0; k < differ.size(); ++k) {
        if (!differs_[k] && (differ[k] || !same_bits(first_->program.constants[k], program.constants[k]))) return false;
      }
      return true;
    }();
    if (serves) return;
    if (loop_ && alike(*first_, *members_[0].step)) {  // what differed once will differ again
      for (std::size_t k = 0; k < differ.size(); ++k) {
        differ[k] = differ[k] || differs_[k] || !same_bits(first_->program.constants[k], program.constants[k]);
      }
    }
    first_ = members_[0].step;
    differs_ = differ;
    const auto flags = std::make_unique<bool[]>(differ.size());
    std::copy(differ.begin(), differ.end(), flags.get());
    loop_ = make_lane_loop(program, {flags.get(), differ.size()}, set_);
  }

  const Member& in_lane(std::size_t lane) const { return members_[std::min(lane, members_.size() - 1)]; }

  void fill() {
    under_way_ = false;
    taken_ = 0;
    carried_.assign(members_[0].step->program.values() * lanes(), 0.0);
    failed_ = std::make_unique<bool[]>(lanes());
    constants_.clear();
    for (std::size_t k = 0; k < differs_.size(); ++k) {
      if (!differs_[k]) continue;
      for (std::size_t lane = 0; lane < lanes(); ++lane) {
        constants_.push_back(in_lane(lane).step->program.constants[k]);
      }
    }
  }
  /// After the first step, which leaves what a method keeps for the next one.
  void read() {
    under_way_ = true;
    std::vector<double> values(members_[0].step->program.values());
    for (std::size_t lane = 0; lane < lanes(); ++lane) {
      Member& member = members_[std::min(lane, members_.size() - 1)];
      if (!member.lost && !member.recorded->read_values(*member.step, values)) member.lost = true;
      for (std::size_t k = 0; k < values.size(); ++k) carried_[k * lanes() + lane] = values[k];
    }
  }

  const ProblemEntry& problem_;
  Request request_;
  LaneSet set_;
  std::vector<Member> members_;
  std::shared_ptr<const RecordedStep> first_;  // of the loop
  std::vector<bool> differs_;
  std::unique_ptr<const LaneLoop> loop_;
  std::vector<double> carried_;
  std::vector<double> constants_;
  std::unique_ptr<bool[]> failed_;
  bool under_way_ = false;
  std::int64_t taken_ = 0;
};

}  // namespace

std::unique_ptr<EnsembleBlock> make_recorded_block(const ProblemEntry& problem, const Request& request, LaneSet lanes) {
  if (!problem.simulate_member || !problem.accepts(request.method)) return nullptr;
  return std::make_unique<RecordedBlock>(problem, request, lanes);
}

}  // namespace hamflow
