#include "recorded_block.hpp"

#include <algorithm>
#include <limits>
#include <map>

#include "block_tangents.hpp"
#include "engine/planetary_steps.hpp"
#include "family_loop.hpp"
#include "member_parameters.hpp"

namespace hamflow {

namespace {

/// Whether bodies came close in a step. In later steps a guard of the recording finds that.
bool meets_closely(const Simulation& simulation) {
  const auto* const planets = dynamic_cast<const PlanetarySteps*>(&simulation);
  return planets != nullptr && planets->first_encounter().has_value();
}

class RecordedBlock final : public EnsembleBlock {
 public:
  RecordedBlock(std::shared_ptr<const ProblemEntry> problem, Request request, LaneSet lanes)
      : problem_(std::move(problem)), request_(std::move(request)), set_(lanes), loop_(lanes) {}

  std::size_t lanes() const override { return loop_.lanes(); }

  bool load(const ParameterShape& shape, std::span<const MemberStart> members) override {
    members_.clear();
    const MemberStart* before = nullptr;
    FamilyLoop::Steps steps;
    for (const MemberStart& start : members) {
      Member member;
      member.simulation =
          problem_->simulate_member(request_, parameters_of(shape, start.parameters), start.q, start.p, start.h);
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
    summed_.clear();
    failed_ = std::make_unique<bool[]>(lanes());
    values_.resize(step().program.values());
    before_.clear();
    taken_ = settled_ = 0;
    return true;
  }

  void advance(std::int64_t steps) override {
    if (steps > 0 && taken_ == 0) {
      for (Member& member : members_) {
        member.lost = member.simulation->advance(1) != Outcome::done || meets_closely(*member.simulation);
      }
      for (std::size_t lane = 0; lane < lanes(); ++lane) read(lane);
      for (std::size_t lane = 0; lane < members_.size(); ++lane) add_to_sums(lane);
      --steps;
      taken_ = 1;
    }
    while (steps > 0) {
      std::int64_t some = steps;
      if (step().words > 0) {
        if (taken_ - settled_ == BounceWord::most_steps) settle();
        some = std::min(some, BounceWord::most_steps - (taken_ - settled_));
      }
      some = (summed_.empty() ? loop_ : summing_loop_).run(carried_, some, {failed_.get(), lanes()});
      taken_ += some;
      steps -= some;
      if (step().stops) step_alone_in_lane();
    }
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
      if (step().words > 0 && taken_ - settled_ == BounceWord::most_steps) settle();
      before_ = carried_;
    }
    keeps_start_ = true;
    advance(1);
    keeps_start_ = false;
  }
  const double* numbers(std::size_t k) const override { return carried_.data() + step().state[k] * lanes(); }
  const Simulation& before_step(std::size_t lane) override {
    Member& member = members_[lane];
    if (member.start && member.start->step() == taken_ - 1) return *member.start;
    for (std::size_t k = 0; k < step().words; ++k) word(carried_, k, lane) -= word(before_, k, lane);
    bring(member, lane, before_, taken_ - 1);
    return *member.simulation;
  }

  bool expect_sums(std::span<const std::span<const NamedExpression>> of_lanes) override {
    if (taken_ > 0) return false;
    const auto with = [&](const Program& program, std::span<const NamedExpression> expressions) {
      const std::optional<std::size_t> undone = step().stops ? std::optional(step().stop()) : std::nullopt;
      return with_sums(program, step().state, undone, expressions);
    };
    const std::optional<Program> first = with(step().program, of_lanes[0]);
    if (!first) return false;
    // Constants in the expressions have to be the same in all lanes, and the same as in an existing loop.
    const auto like_first = [&](const Program& other) {
      return other.operations == first->operations && other.outputs == first->outputs &&
             other.constants.size() == first->constants.size() &&
             std::equal(other.constants.begin() + static_cast<std::ptrdiff_t>(step().program.constants.size()),
                        other.constants.end(),
                        first->constants.begin() + static_cast<std::ptrdiff_t>(step().program.constants.size()));
    };
    for (const auto expressions : of_lanes) {
      const std::optional<Program> other = with(step().program, expressions);
      if (!other || !like_first(*other)) return false;
    }
    if (!last_summing_ || !like_first(*last_summing_)) summing_loop_ = FamilyLoop(set_);
    last_summing_ = first;
    FamilyLoop::Steps steps;
    for (const Member& member : members_) steps.push_back(member.step);
    if (!summing_loop_.load(steps, [&](const Program& program) { return with(program, of_lanes[0]); })) return false;
    summed_.assign(of_lanes.begin(), of_lanes.end());
    carried_.resize((step().program.values() + 2 * summed_[0].size()) * lanes(), 0.0);
    return true;
  }
  std::vector<StepSum> sums(std::size_t lane) const override {
    std::vector<StepSum> all;
    for (std::size_t i = 0; i < summed_[lane].size(); ++i) {
      all.push_back({carried_[place_of_sum(i) * lanes() + lane], carried_[(place_of_sum(i) + 1) * lanes() + lane]});
    }
    return all;
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
    std::unique_ptr<Simulation> simulation;  // after the first step, or at a later step where it was needed
    std::unique_ptr<Simulation> start;       // before the first step, or before the last one that it took alone
    RecordedMember* recorded = nullptr;      // the interface of `simulation`
    std::shared_ptr<const RecordedStep> step;
    bool has_step_of_last = false;  // whether parameters and step size equal those of the previous member
    bool lost = false;
  };

  const RecordedStep& step() const { return *members_[0].step; }

  /// Reads the numbers of a lane after the first step, which computes the data that a method keeps for the next one.
  void read(std::size_t lane) {
    Member& member = members_[std::min(lane, members_.size() - 1)];
    if (!member.lost && !member.recorded->read_values(*member.step, values_)) member.lost = true;
    for (std::size_t k = 0; k < values_.size(); ++k) carried_[k * lanes() + lane] = values_[k];
  }

  std::size_t place_of_sum(std::size_t i) const { return step().program.values() + 2 * i; }
  /// Adds the values of the expressions after a step that the member took alone.
  void add_to_sums(std::size_t lane) {
    if (summed_.empty() || members_[lane].lost) return;
    Frame frame;
    members_[lane].simulation->look(frame);
    std::vector<StepSum> all = sums(lane);
    for (std::size_t i = 0; i < all.size(); ++i) {
      all[i].add(summed_[lane][i].expression(frame));
      carried_[place_of_sum(i) * lanes() + lane] = all[i].sum;
      carried_[(place_of_sum(i) + 1) * lanes() + lane] = all[i].lost;
    }
  }

  /// Advances the simulation of a member to the state of its lane.
  void bring(Member& member, std::size_t lane, LaneNumbers& carried, std::int64_t taken) {
    const std::int64_t steps = taken - member.simulation->step();
    if (steps == 0) return;
    for (std::size_t k = 0; k < values_.size(); ++k) values_[k] = carried[k * lanes() + lane];
    member.recorded->take_values(*member.step, values_, steps);
    for (std::size_t k = 0; k < step().words; ++k) word(carried, k, lane) = 0;  // the simulation has counted them
  }
  double& word(LaneNumbers& carried, std::size_t k, std::size_t lane) const {
    return carried[(step().first_word() + k) * lanes() + lane];
  }
  /// Adds the bounces of all lanes to their members, before a word overflows.
  void settle() {
    for (std::size_t lane = 0; lane < lanes(); ++lane) {
      if (lane < members_.size() && !is_lost(lane)) bring(members_[lane], lane, carried_, taken_);
      for (std::size_t k = 0; k < step().words; ++k) word(carried_, k, lane) = 0;
    }
    settled_ = taken_;
  }

  /// The next step of a lane may hit a wall and was not taken. The member takes it alone and writes its numbers back.
  void step_alone_in_lane() {
    double* const stop = carried_.data() + step().stop() * lanes();
    for (std::size_t lane = 0; lane < lanes(); ++lane) {
      const bool stands_for_last = lane >= members_.size();
      Member& member = members_[std::min(lane, members_.size() - 1)];
      if (member.lost || (!stands_for_last && failed_[lane])) {
        give_up(lane);
      } else if (stop[lane] != 0) {
        if (!stands_for_last) step_alone(member, lane);
        read(lane);
        if (member.lost) give_up(lane);
      }
    }
  }
  void step_alone(Member& member, std::size_t lane) {
    bring(member, lane, carried_, taken_ - 1);
    if (keeps_start_) member.start = member.simulation->clone();
    member.lost = member.recorded->step_ordinarily(*member.step) != Outcome::done;
    if (!member.lost) member.recorded->make_ready();
    add_to_sums(lane);
  }
  /// Marks a lane as lost, so that it no longer stops the others.
  void give_up(std::size_t lane) {
    for (std::size_t k = 0; k < values_.size(); ++k) {
      carried_[k * lanes() + lane] = std::numeric_limits<double>::quiet_NaN();
    }
    carried_[step().stop() * lanes() + lane] = 0;
  }

  FamilyLoop::Steps tangent_steps(RecordedAt at) {
    FamilyLoop::Steps steps;
    for (const Member& member : members_) {
      steps.push_back(member.has_step_of_last ? steps.back() : member.recorded->tangent_step(at));
    }
    return steps;
  }

  std::shared_ptr<const ProblemEntry> problem_;
  Request request_;
  LaneSet set_;
  FamilyLoop loop_;
  std::vector<Member> members_;
  LaneNumbers carried_;
  LaneNumbers before_;  // the numbers before the last step
  std::unique_ptr<bool[]> failed_;
  std::vector<double> values_;  // the values of one lane
  std::int64_t taken_ = 0;
  std::int64_t settled_ = 0;  // the last step after which all words were 0
  bool keeps_start_ = false;
  FamilyLoop summing_loop_{LaneSet::none};
  std::optional<Program> last_summing_;                   // the program of that loop
  std::vector<std::span<const NamedExpression>> summed_;  // the expressions summed in each lane; may be empty
  std::map<std::size_t, BlockTangents> tangents_;         // by the number of vectors
};

}  // namespace

std::unique_ptr<EnsembleBlock> make_recorded_block(const std::shared_ptr<const ProblemEntry>& problem,
                                                   const Request& request, LaneSet lanes) {
  if (!problem->simulate_member || !problem->accepts(request.method)) return nullptr;
  return std::make_unique<RecordedBlock>(problem, request, lanes);
}

}  // namespace hamflow
