#include "iterated_block.hpp"

#include <algorithm>
#include <limits>
#include <map>
#include <optional>

#include "iterated_pack.hpp"
#include "member_parameters.hpp"

namespace hamflow {

namespace {

/// Runs members with the same number of quadrature points together. A member that changes its number of points, or has
/// no initial guess, runs alone for the rest of a stretch of steps, and then joins the others again.
class IteratedBlock final : public EnsembleBlock {
 public:
  IteratedBlock(std::shared_ptr<const ProblemEntry> problem, Request request, LaneSet lanes)
      : problem_(std::move(problem)), request_(std::move(request)), set_(lanes) {
    request_.record = false;  // members run in lanes
  }

  /// The number of lanes of several packs, because members with different numbers of points need different packs.
  std::size_t lanes() const override { return 8 * (set_ == LaneSet::avx512 ? 8 : 4); }

  bool load(const ParameterShape& shape, std::span<const MemberStart> members) override {
    members_.clear();
    for (auto& [points, family] : families_) family.clear();
    taken_ = in_lanes_ = 0;
    for (const MemberStart& start : members) {
      Member member;
      member.simulation =
          problem_->simulate_member(request_, parameters_of(shape, start.parameters), start.q, start.p, start.h);
      member.iterated = dynamic_cast<IteratedMember*>(member.simulation.get());
      if (member.iterated == nullptr || !can_run_in_lanes(*member.simulation, *member.iterated)) return false;
      const std::size_t i = members_.size();
      if (i > 0)
        member.parameters = members_[i - 1].parameters + (start.parameters == members[i - 1].parameters ? 0 : 1);
      member.frame.resize(member.iterated->frame().size());
      members_.push_back(std::move(member));
      read(members_.back());
    }
    return true;
  }

  void advance(std::int64_t steps) override {
    for (; steps > 0; steps -= std::min(steps, stretch)) take(std::min(steps, stretch));
  }

  std::int64_t steps_in_lanes() const override { return in_lanes_; }

  MemberEnd look(std::size_t lane) override {
    Member& member = members_[lane];
    MemberEnd end;
    if (member.lost) return end;
    if (member.in_lane) bring(member, member.frame, taken_, member.effort);
    Frame frame;
    member.simulation->look(frame);
    end.q = frame.q;
    end.p = frame.p;
    end.energy = member.simulation->energy();
    end.invariants = member.simulation->invariants();
    end.walls = member.simulation->wall_counts();
    end.halved = member.simulation->effort().halved;
    const auto is_finite = [](double x) { return std::abs(x) <= std::numeric_limits<double>::max(); };
    end.regular = is_finite(end.energy.final) && is_finite(end.energy.max_error) &&
                  std::all_of(end.q.begin(), end.q.end(), is_finite) &&
                  std::all_of(end.p.begin(), end.p.end(), is_finite);
    return end;
  }

  bool is_lost(std::size_t lane) const override { return members_[lane].lost; }

  void show(std::size_t lane, Frame& frame) const override {
    const Member& member = members_[lane];
    if (taken_ == 0) return member.simulation->look(frame);
    const std::size_t n = member.iterated->frame().n;
    frame.step = taken_;
    frame.time = member.iterated->time_after(taken_ - member.simulation->step());
    frame.q.resize(n);
    frame.p.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
      frame.q[i] = member.frame[IterationFrame::state(i)];
      frame.p[i] = member.frame[IterationFrame::state(n + i)];
    }
  }

  void take_step() override {
    keeps_before_ = true;
    for (Member& member : members_) {
      member.before = nullptr;
      member.frame_before = member.frame;
      member.effort_before = member.effort;
    }
    take(1);
    keeps_before_ = false;
    numbers_.resize(2 * members_[0].iterated->frame().n * lanes());
    for (std::size_t k = 0; k < numbers_.size() / lanes(); ++k) {
      for (std::size_t i = 0; i < members_.size(); ++i) {
        numbers_[k * lanes() + i] = members_[i].frame[IterationFrame::state(k)];
      }
    }
  }
  const double* numbers(std::size_t k) const override { return numbers_.data() + k * lanes(); }
  const Simulation& before_step(std::size_t lane) override {
    Member& member = members_[lane];
    if (member.before) return *member.before;
    bring(member, member.frame_before, taken_ - 1, member.effort_before);
    return *member.simulation;
  }

  /// Not supported: an iterated step is not a program that could be differentiated.
  bool expect_tangents(std::size_t) override { return false; }
  void carry(std::span<LaneTangents>) override {}

 private:
  struct Member {
    std::unique_ptr<Simulation> simulation;  // at the start, or at a later step where it was needed
    IteratedMember* iterated = nullptr;      // the interface of `simulation`
    std::size_t parameters = 0;              // the number of its parameter set
    std::vector<double> frame;               // the present state of the member
    int points = 0;                          // the number of points of its next step
    Effort effort;
    bool in_lane = false;    // whether `frame` has the present state; else `simulation` has it
    bool has_guess = false;  // whether the last step left an initial guess for the next one
    bool lost = false;
    std::unique_ptr<Simulation> before;  // the state before the last step that the member took alone
    std::vector<double> frame_before;
    Effort effort_before;
  };
  static constexpr std::int64_t stretch = 16;

  /// Whether a member can run in lanes. The programs do not support a tolerance, `simplified` and diagnostics. Whether
  /// a step can be recorded is known only after the first one.
  bool can_run_in_lanes(const Simulation& simulation, const IteratedMember& member) {
    const NewtonOptions options = member.newton();
    if (!member.can_be_recorded() || options.tolerance || options.diagnostics ||
        options.iteration == Iteration::simplified) {
      return false;
    }
    if (!is_recorded_) {
      const auto copy = simulation.clone();
      if (copy->advance(2) != Outcome::done) return true;  // only this member fails
      is_recorded_ = dynamic_cast<const IteratedMember&>(*copy).recorded_iteration().has_value();
    }
    return *is_recorded_;
  }

  /// Takes at most one stretch of steps.
  void take(std::int64_t steps) {
    std::map<int, std::vector<Member*>> together;
    std::vector<Member*> alone;
    for (Member& member : members_) {
      if (member.lost) continue;
      if (!member.in_lane) join(member, steps);
      if (member.in_lane) {
        together[member.points].push_back(&member);
      } else {
        alone.push_back(&member);
      }
    }
    for (auto& [points, members] : together) {
      IteratedFamily& family = families_.at(points);
      for (std::size_t first = 0; first < members.size(); first += family.lanes()) {
        go_together(family, std::span(members).subspan(first, std::min(family.lanes(), members.size() - first)), steps);
      }
    }
    taken_ += steps;
    for (Member* member : alone) run_unstarted_alone(*member, steps);
  }

  void go_together(const IteratedFamily& family, std::span<Member* const> members, std::int64_t steps) {
    pack_.clear();
    for (Member* member : members) pack_.push_back({member->frame, &member->effort, member->parameters});
    const IteratedMember& first = *members[0]->iterated;
    const int points = members[0]->points;
    const auto alone = [&](std::size_t lane, std::int64_t left) {
      Member& member = *members[lane];
      bring(member, member.frame, taken_ + steps - left, member.effort);
      run_unstarted_alone(member, 1);
      if (!member.lost && member.has_guess && member.points == points) return true;
      member.in_lane = false;
      run_unstarted_alone(member, left - 1);
      return false;
    };
    in_lanes_ += runner_.run(family, first.newton(), first.automatic(), pack_, steps, alone);
  }

  void run_unstarted_alone(Member& member, std::int64_t steps) {
    if (steps == 0 || member.lost) return;
    if (keeps_before_) member.before = member.simulation->clone();
    if (member.simulation->advance(steps) != Outcome::done) {
      member.lost = true;
    } else {
      read(member);
    }
  }

  /// Reads the state of a member from its simulation.
  void read(Member& member) {
    member.has_guess = member.iterated->read(member.frame);
    member.points = member.iterated->points();
    member.effort = member.simulation->effort();
  }

  void join(Member& member, std::int64_t steps) {
    if (!member.has_guess) return;
    IteratedFamily& family = families_.try_emplace(member.points, set_).first->second;
    member.in_lane = family.is_worth_recording(steps) && family.add_parameter_set(member.parameters, *member.iterated);
  }

  /// Advances the simulation of a member to the state of a frame.
  void bring(Member& member, std::span<const double> frame, std::int64_t taken, const Effort& effort) {
    const std::int64_t steps = taken - member.simulation->step();
    if (steps != 0) member.iterated->take(frame, steps, effort);
  }

  std::shared_ptr<const ProblemEntry> problem_;
  Request request_;
  LaneSet set_;
  std::vector<Member> members_;
  std::map<int, IteratedFamily> families_;  // by the number of points
  std::vector<PackLane> pack_;
  IteratedPack runner_;
  std::vector<double> numbers_;  // the numbers of the state in all lanes
  std::int64_t taken_ = 0;
  std::int64_t in_lanes_ = 0;
  bool keeps_before_ = false;
  std::optional<bool> is_recorded_;  // whether the step of the members can be recorded, if this is known
};

}  // namespace

std::unique_ptr<EnsembleBlock> make_iterated_block(const std::shared_ptr<const ProblemEntry>& problem,
                                                   const Request& request, LaneSet lanes) {
  if (!problem->simulate_member || !problem->accepts(request.method) || lanes == LaneSet::generic) return nullptr;
  return std::make_unique<IteratedBlock>(problem, request, lanes);
}

}  // namespace hamflow
