#include "recorded_block.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "block_tangents.hpp"
#include "family_loop.hpp"
#include "member_parameters.hpp"

namespace hamflow {

namespace {

class RecordedBlock final : public EnsembleBlock {
 public:
  RecordedBlock(const ProblemEntry& problem, Request request, LaneSet lanes)
      : problem_(problem), request_(std::move(request)), set_(lanes), loop_(lanes) {}

  std::size_t lanes() const override { return loop_.lanes(); }

  bool load(const ParameterShape& shape, std::span<const MemberStart> members) override {
    members_.clear();
    const MemberStart* before = nullptr;
    FamilyLoop::Steps steps;
    for (const MemberStart& start : members) {
      Member member;
      member.simulation =
          problem_.simulate_member(request_, parameters_of(shape, start.parameters), start.q, start.p, start.h);
      member.recorded = dynamic_cast<RecordedMember*>(member.simulation.get());
      if (member.recorded == nullptr) return false;
      member.has_step_of_last = before != nullptr && before->parameters == start.parameters && before->h == start.h;
      member.step = member.has_step_of_last ? members_.back().step : member.recorded->recorded_step();
      if (!member.step) return false;
      steps.push_back(member.step);
      before = &start;
      members_.push_back(std::move(member));
    }
    if (!loop_.load(steps)) return false;
    carried_.assign(step().program.values() * lanes(), 0.0);
    failed_ = std::make_unique<bool[]>(lanes());
    values_.resize(step().program.values());
    before_.clear();
    taken_ = 0;
    return true;
  }

  void advance(std::int64_t steps) override {
    if (steps > 0 && taken_ == 0) {
      for (Member& member : members_) member.lost = member.simulation->advance(1) != Outcome::done;
      for (std::size_t lane = 0; lane < lanes(); ++lane) read(lane);
      --steps;
      taken_ = 1;
    }
    if (steps == 0) return;
    loop_.run(carried_, steps, {failed_.get(), lanes()});
    taken_ += steps;
  }

  std::int64_t steps_in_lanes() const override { return taken_ * static_cast<std::int64_t>(members_.size()); }

  MemberEnd look(std::size_t lane) override {
    Member& member = members_[lane];
    MemberEnd end;
    if (is_lost(lane)) return end;
    constexpr double most = std::numeric_limits<double>::max();
    end.regular = true;
    for (std::size_t k = 0; taken_ > 0 && k < values_.size(); ++k) {
      end.regular = end.regular && std::abs(carried_[k * lanes() + lane]) <= most;
    }
    bring(member, lane, carried_, taken_);
    Frame frame;
    member.simulation->look(frame);
    end.q = frame.q;
    end.p = frame.p;
    end.energy = member.simulation->energy();
    end.energy_scale = member.simulation->energy_scale();
    end.invariants = member.simulation->invariants();
    end.walls = member.simulation->wall_counts();
    end.halved = member.simulation->effort().halved;
    end.regular = end.regular && std::abs(end.energy.final) <= most && end.energy.max_error <= most;
    return end;
  }

  bool is_lost(std::size_t lane) const override { return members_[lane].lost || failed_[lane]; }

  void show(std::size_t lane, Frame& frame) const override {
    const Member& member = members_[lane];
    if (taken_ == 0) return member.simulation->look(frame);
    const std::size_t n = step().state.size() / 2;
    frame.step = taken_;
    frame.time = member.recorded->time_after(taken_ - member.simulation->step());
    frame.q.resize(n);
    frame.p.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      frame.q[i] = numbers(i)[lane];
      frame.p[i] = numbers(n + i)[lane];
    }
  }

  void take_step() override {
    if (taken_ == 0) {
      for (Member& member : members_) member.start = member.simulation->clone();
    } else {
      before_ = carried_;
    }
    advance(1);
  }
  const double* numbers(std::size_t k) const override { return carried_.data() + step().state[k] * lanes(); }
  const Simulation& before_step(std::size_t lane) override {
    Member& member = members_[lane];
    if (taken_ == 1) return *member.start;
    bring(member, lane, before_, taken_ - 1);
    return *member.simulation;
  }

  bool expect_tangents(std::size_t vectors) override {
    BlockTangents& tangents = tangents_.try_emplace(vectors, set_, vectors).first->second;
    return tangents.load(tangent_steps(RecordedAt::start), tangent_steps(RecordedAt::steady));
  }
  void carry(std::span<LaneTangents> jobs) override {
    if (!jobs.empty()) tangents_.at(jobs[0].vectors->size()).carry(jobs);
  }

 private:
  struct Member {
    std::unique_ptr<Simulation> simulation;  // at the first step, or at one that was looked at since
    std::unique_ptr<Simulation> start;
    RecordedMember* recorded = nullptr;  // the same
    std::shared_ptr<const RecordedStep> step;
    bool has_step_of_last = false;  // parameters and step length are those of the last member
    bool lost = false;
  };

  const RecordedStep& step() const { return *members_[0].step; }

  /// After the first step, which leaves what a method keeps for the next one.
  void read(std::size_t lane) {
    Member& member = members_[std::min(lane, members_.size() - 1)];
    if (!member.lost && !member.recorded->read_values(*member.step, values_)) member.lost = true;
    for (std::size_t k = 0; k < values_.size(); ++k) carried_[k * lanes() + lane] = values_[k];
  }

  /// The member's simulation, which is behind, to where a lane is.
  void bring(Member& member, std::size_t lane, const LaneNumbers& carried, std::int64_t taken) {
    const std::int64_t steps = taken - member.simulation->step();
    if (steps == 0) return;
    for (std::size_t k = 0; k < values_.size(); ++k) values_[k] = carried[k * lanes() + lane];
    member.recorded->take_values(*member.step, values_, steps);
  }

  FamilyLoop::Steps tangent_steps(RecordedAt at) {
    FamilyLoop::Steps steps;
    for (const Member& member : members_) {
      steps.push_back(member.has_step_of_last ? steps.back() : member.recorded->tangent_step(at));
    }
    return steps;
  }

  const ProblemEntry& problem_;
  Request request_;
  LaneSet set_;
  FamilyLoop loop_;
  std::vector<Member> members_;
  LaneNumbers carried_;
  LaneNumbers before_;  // the last step
  std::unique_ptr<bool[]> failed_;
  std::vector<double> values_;  // of one lane
  std::int64_t taken_ = 0;
  std::map<std::size_t, BlockTangents> tangents_;  // by the number of vectors
};

}  // namespace

std::unique_ptr<EnsembleBlock> make_recorded_block(const ProblemEntry& problem, const Request& request, LaneSet lanes) {
  if (!problem.simulate_member || !problem.accepts(request.method)) return nullptr;
  return std::make_unique<RecordedBlock>(problem, request, lanes);
}

}  // namespace hamflow
