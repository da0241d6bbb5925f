#include "walled_simulation.hpp"

#include <algorithm>
#include <limits>
#include <optional>
#include <stdexcept>

#include "bounces_in_numbers.hpp"
#include "core/outside_note.hpp"
#include "engine/recorded_step.hpp"
#include "engine/wall_failures.hpp"
#include "hamflow/detail/core/archive.hpp"
#include "hamflow/detail/run/step_sums.hpp"
#include "run_walls.hpp"
#include "wall_events.hpp"

namespace hamflow {

namespace {

template <class R>
class WalledSimulation : public Simulation {
  using Parts = StepsInParts<R>;
  using Place = typename Parts::Place;
  static constexpr int most_bounces = 1000;  // in one step

 public:
  WalledSimulation(std::unique_ptr<Simulation> inner, std::shared_ptr<const RunWalls<R>> walls)
      : inner_(std::move(inner)),
        parts_(dynamic_cast<Parts*>(inner_.get())),
        recorded_(dynamic_cast<RecordedMember*>(inner_.get())),
        in_numbers_(dynamic_cast<HasPartsInNumbers*>(inner_.get())),
        walls_(std::move(walls)),
        has_own_substeps_(inner_->method().own_substeps),
        order_(inner_->method().order),
        counts_(walls_->sides.size()) {
    if (parts_ == nullptr) throw Error("hamflow: a simulation with walls must support partial steps");
    if constexpr (std::is_same_v<R, double>) {
      if (walls_->turns_single && in_numbers_ != nullptr)
        bounces_in_numbers_.emplace(*walls_->functions, walls_->sides);
    }
  }

  Outcome advance(std::int64_t steps) final {
    why_.clear();
    outside_.reset();
    const OutsideNote note(outside_);
    while (steps > 0) {
      const std::int64_t recorded = walls_->rule == WallRule::soft ? 0 : parts_->take_recorded(steps, counted());
      steps -= recorded;
      undone_ = recorded_ != nullptr ? recorded_->undone_step() : nullptr;
      if (steps == 0) break;
      const std::int64_t some = walls_->rule == WallRule::soft ? steps : 1;
      const Outcome outcome = some == 1 ? take_step() : inner_->advance(some);
      if (outcome != Outcome::done) return explained(outcome);
      add_step();
      steps -= some;
    }
    return Outcome::done;
  }
  std::int64_t step() const override { return inner_->step(); }
  void look(Frame& frame) const override {
    inner_->look(frame);
    add_discarded_work(frame.effort);
  }
  void reverse_time() override { inner_->reverse_time(); }
  void negate_momenta() override { inner_->negate_momenta(); }
  std::vector<std::byte> bits() const override { return inner_->bits(); }
  Excursion energy() const override { return inner_->energy(); }
  void restart_energy_range() override { inner_->restart_energy_range(); }
  std::vector<InvariantExcursion> invariants() const override { return inner_->invariants(); }
  std::optional<ConstraintResiduals> constraints() const override { return inner_->constraints(); }
  Effort effort() const override {
    Effort all = inner_->effort();
    add_discarded_work(all);
    return all;
  }
  StepDiagnostics diagnostics() const override { return inner_->diagnostics(); }
  MethodInfo method() const override { return inner_->method(); }
  std::string failure() const override { return why_.empty() ? inner_->failure() : why_; }
  bool is_recorded() const override { return inner_->is_recorded(); }
  std::vector<WallCount> wall_counts() const override {
    std::vector<WallCount> all;
    for (std::size_t k = 0; k < counts_.size(); ++k) {
      all.push_back({walls_->sides[k].coordinate, walls_->sides[k].side, counts_[k]});
    }
    return all;
  }
  void on_bounce(std::function<void(const Bounce&)> callback) override { on_bounce_ = std::move(callback); }
  /// Steps that are not recorded add to the sums here.
  bool add_to_sums(std::span<const NamedExpression> summed, std::span<StepSum> sums) override {
    if (!inner_->add_to_sums(summed, sums)) return false;
    if (walls_->rule != WallRule::soft) summed_ = summed, sums_ = sums;
    return true;
  }
  std::vector<std::byte> save() const override {
    Writer ar;
    ar(inner_->save(), counts_, discarded_work_);
    return ar.take();
  }
  void restore(std::span<const std::byte> saved) override {
    Reader ar(saved);
    std::vector<std::byte> inner;
    std::vector<std::int64_t> counts;
    Effort discarded_work;
    ar(inner, counts, discarded_work);
    ar.finish();
    if (counts.size() != counts_.size()) throw Error("the saved state belongs to other walls");
    inner_->restore(inner);
    counts_ = std::move(counts);
    discarded_work_ = discarded_work;
  }
  std::unique_ptr<Simulation> clone() const override { return copy(); }
  Outcome look_ahead(const std::string& time, Frame& frame) const override {
    if (!bounces_within_parts()) return inner_->look_ahead(time, frame);
    const R now = parts_->present_time();
    const R t = evaluate_number<R>(time);
    if (abs(t - now) <= 4 * std::numeric_limits<R>::epsilon() * abs(t)) {
      look(frame);
      return Outcome::done;
    }
    return show_after(t - now, t, frame);
  }
  Outcome look_part(double theta, Frame& frame) const override {
    if (theta == 0 || !bounces_within_parts()) return inner_->look_part(theta, frame);
    const R part = R(theta) * parts_->length_of_step();
    return show_after(part, parts_->present_time() + part, frame);
  }

 protected:
  /// Adds the work of steps that ended beyond a wall and were repeated.
  void add_discarded_work(Effort& all) const {
    add_evaluations(all, discarded_work_);
    all.steps += discarded_work_.steps;
    all.solves_max = std::max(all.solves_max, discarded_work_.solves_max);
  }
  /// Whether partial steps include bounces. A sample within a rejected step shows the discarded path; soft walls are a
  /// term of H.
  bool bounces_within_parts() const { return walls_->rule == WallRule::event || walls_->rule == WallRule::mirror; }
  std::unique_ptr<WalledSimulation> copy() const {
    auto other = std::make_unique<WalledSimulation>(inner_->clone(), walls_);
    other->counts_ = counts_;
    other->discarded_work_ = discarded_work_;
    return other;
  }
  /// Computed on a copy, so that it changes nothing and reports no bounces.
  Outcome show_after(const R& part, const R& t, Frame& frame) const {
    const auto other = copy();
    Outcome outcome = Outcome::done;
    if (walls_->rule == WallRule::mirror) {
      outcome = other->parts_->take_part(part);
      other->mirror_inside();
    } else {
      other->in_pieces_ = has_own_substeps_;
      outcome = other->advance_with_bounces(part);
    }
    if (outcome == Outcome::done) other->parts_->show_at(t, frame);
    if (outcome == Outcome::done) frame.effort = effort();
    return outcome;
  }

  Outcome take_step() {
    in_pieces_ = false;
    // Evaluations at the beginning of a step count as part of the step, whichever path takes it.
    if (walls_->rule == WallRule::event) parts_->prepare();
    // A loop that ended at this step decided the same as stays_inside, with the same work.
    const bool is_undone = walls_->rule == WallRule::event && undone_ != nullptr;
    if (is_undone) {
      add_evaluations(discarded_work_, std::exchange(undone_, nullptr)->effort);
      if (bounce_in_numbers()) {
        tell();
        return Outcome::done;
      }
    }
    parts_->remember_state(Place::step);
    if (is_undone) return after_walls(bounce(Outcome::done));
    const Effort before = inner_->effort();
    const Effort discarded_work_before = discarded_work_;
    const V q0 = parts_->present_positions();
    const V v0 = walls_->rule == WallRule::event ? velocity(q0, parts_->present_momenta()) : V();
    Outcome outcome = inner_->advance(1);
    if (walls_->rule == WallRule::soft || (outcome != Outcome::done && walls_->rule != WallRule::event)) return outcome;
    Effort spent;
    add_evaluations(spent, inner_->effort(), before);
    in_pieces_ = searches_within_steps() && (starts_at_rest(v0) || has_several_parts(outcome, spent));
    if (outcome == Outcome::done && !in_pieces_ && stays_inside(q0, v0)) return outcome;
    if (walls_->rule == WallRule::event) {
      parts_->restore_state(Place::step);
      outcome = bounce(outcome);
    } else {
      outcome = walls_->rule == WallRule::reject ? reject(spent) : mirror();
    }
    if (outcome == Outcome::done) {
      if (walls_->rule == WallRule::event) add_evaluations(discarded_work_, spent);
      count_as_one(before, discarded_work_before);
    }
    return after_walls(outcome);
  }
  void add_step() {
    if (summed_.empty()) return;
    inner_->look(frame_);
    for (std::size_t i = 0; i < summed_.size(); ++i) sums_[i].add(summed_[i].expression(frame_));
  }
  Outcome after_walls(Outcome outcome) {
    if (outcome != Outcome::done) return back_with(outcome);
    tell();
    return Outcome::done;
  }

  /// If no callback needs the bounces, recorded steps carry them out and count them.
  std::span<std::int64_t> counted() {
    if (on_bounce_ || !walls_->in_steps) return {};
    return counts_;
  }

  using V = Vector<R, dynamic>;
  V velocity(const V& q, const V& p) const {
    V v = zeros_like(p);
    if (walls_->functions->has_parts()) {
      walls_->functions->velocity(p, v);
    } else {
      V by_q = zeros_like(q);
      walls_->functions->gradient(q, p, by_q, v);
    }
    return v;
  }

  /// Whether steps with both ends inside are tested by is_long. Loops of recorded steps test only their tangents, and
  /// which steps run in loops depends on lanes, samples and resuming; so all steps of a method that can be recorded
  /// have the same test.
  bool searches_within_steps() const { return walls_->rule == WallRule::event && recorded_ == nullptr; }
  /// Whether a step may consist of several sub-steps, judged by its work: a sub-step costs as many evaluations as a
  /// series has terms, or one and a half times the order for the stages of dop853. It may be true for a single sub-step
  /// (after a rejection, or if the work is unknown); the search then takes longer and finds the same.
  bool has_several_parts(Outcome outcome, const Effort& spent) const {
    if (!has_own_substeps_) return false;
    return outcome != Outcome::done || 2 * (spent.force + spent.gradient) > 3 * order_;
  }
  /// Whether the step starts at rest. If each step is a whole period, the ends of steps would show only rest.
  bool starts_at_rest(const V& v0) const {
    return inner_->step() <= 1 && std::any_of(walls_->sides.begin(), walls_->sides.end(),
                                              [&](const WallSide<R>& wall) { return v0[wall.coordinate] == R(0); });
  }

  /// Whether the step certainly stayed within the walls (see stays_within, src/engine/recorded_step.hpp).
  bool stays_inside(const V& q0, const V& v0) const {
    const V q1 = parts_->present_positions();
    const bool and_turns = walls_->rule == WallRule::event;
    const V v1 = and_turns ? velocity(q1, parts_->present_momenta()) : V();
    const R h = parts_->length_of_step();
    return std::all_of(walls_->sides.begin(), walls_->sides.end(), [&](const WallSide<R>& wall) {
      const std::size_t i = wall.coordinate;
      if (wall.beyond(R(q1[i])) > R(0)) return false;
      if (!and_turns) return true;
      const R side = R(wall.side) * h;
      if (searches_within_steps() &&
          WallSearch<R>::is_long(wall.beyond(q0[i]), side * v0[i], wall.beyond(q1[i]), side * v1[i])) {
        return false;
      }
      return !(wall.beyond_between(q0[i], R(R(2) * h * v0[i]), q1[i], R(R(2) * h * v1[i])) > R(0));
    });
  }

  /// The rule of the listing [Sonnleitner2010, pp. 84, 103]: restores the old state and reverses one momentum (for two
  /// walls at once, that of the last); the time of the step passes.
  Outcome reject(const Effort& spent) {
    const V q1 = parts_->present_positions();
    if (!parts_->restore_state_keeping_effort(Place::step)) {
      parts_->restore_state(Place::step);
      add_evaluations(discarded_work_, spent);
    }
    std::size_t last = 0;
    for (std::size_t k = 0; k < walls_->sides.size(); ++k) {
      const WallSide<R>& wall = walls_->sides[k];
      if (!(wall.beyond(R(q1[wall.coordinate])) > R(0))) continue;
      met_.push_back({k, parts_->length_of_step()});
      last = wall.coordinate;
    }
    WallEvents<R> events(*parts_, *walls_->functions, walls_->sides);
    if (!events.reflect(last)) return no_other_root(last);
    parts_->forget_momenta();
    for (Met& met : met_) keep_state(met);
    return parts_->complete_step();
  }

  /// Maps a state beyond walls back inside, one reflection after the other: there the motion of the mirrored H is the
  /// mirror image of that of H.
  bool mirror_inside() {
    for (int n = 0; n <= most_bounces; ++n) {
      const V q = parts_->present_positions();
      const auto wall = std::find_if(walls_->sides.begin(), walls_->sides.end(),
                                     [&](const WallSide<R>& side) { return side.beyond(q[side.coordinate]) > R(0); });
      if (wall == walls_->sides.end()) return true;
      parts_->mirror_position(wall->coordinate, R(2) * wall->at);
      parts_->negate_momentum(wall->coordinate);
      parts_->forget_mirrored(wall->coordinate);
      met_.push_back({static_cast<std::size_t>(wall - walls_->sides.begin()), R(0)});
      keep_state(met_.back());
      // With several bounces in one step, all but the last leave the coordinate outside.
      if (on_bounce_) met_.back().q[wall->coordinate] = wall->at;
    }
    return false;
  }

  Outcome mirror() {
    if (!mirror_inside()) {
      why_ = "more than " + std::to_string(most_bounces) + " bounces in one step, the last off the wall of " +
             walls_->names[met_.back().side];
      return Outcome::wall;
    }
    return Outcome::done;
  }

  /// Takes the step in parts, from wall to wall. If it hits no wall after all, it is taken whole, with the method's
  /// memory.
  /// @param whole the outcome of the whole step
  Outcome bounce(Outcome whole) {
    const Effort spent_before = parts_->effort_of_parts();
    const Effort before = inner_->effort();
    const Outcome outcome = advance_with_bounces(parts_->length_of_step());
    if (outcome != Outcome::done) return outcome;
    add_evaluations(discarded_work_, parts_->effort_of_parts(), spent_before);
    if (met_.empty()) {
      parts_->restore_state(Place::step);
      return whole == Outcome::done ? inner_->advance(1) : whole;
    }
    Effort kept;
    add_evaluations(kept, inner_->effort(), before);
    add_evaluations(discarded_work_, {}, kept);
    return parts_->complete_step();
  }

  /// As bounce(), with machine code only and without saving the state. @return false if nothing was done
  bool bounce_in_numbers() {
    if constexpr (std::is_same_v<R, double>) {
      PartsInNumbers* const numbers = bounces_in_numbers_ ? in_numbers_->parts_in_numbers() : nullptr;
      if (numbers == nullptr) return false;
      const std::size_t n = numbers->part().size;
      const auto bounced = [&](std::size_t side, double after) {
        met_.push_back({side, after});
        for (std::size_t i = 0; on_bounce_ && i < n; ++i) {
          if (i == 0) met_.back().q = met_.back().p = V(n);
          met_.back().q[i] = numbers->position(i);
          met_.back().p[i] = numbers->momentum(i);
        }
        return met_.size() <= most_bounces;
      };
      const Effort before = inner_->effort();
      if (bounces_in_numbers_->take(*numbers, parts_->length_of_step(), bounced) && !met_.empty() &&
          in_numbers_->write_back_state()) {
        Effort kept;
        add_evaluations(kept, inner_->effort(), before);
        add_evaluations(discarded_work_, numbers->effort(), kept);
        if (parts_->complete_step() != Outcome::done)
          throw std::logic_error("hamflow: a part of a step that was evaluated cannot be taken");
        return true;
      }
      met_.clear();
    }
    return false;
  }

  /// Advances by Psi_length with bounces, which are listed in met_.
  Outcome advance_with_bounces(const R& length) {
    R left = length;
    while (true) {
      parts_->remember_state(Place::path);
      WallEvents<R> events(*parts_, *walls_->functions, walls_->sides);
      typename WallEvents<R>::Hit hit;
      const auto found = events.first(left, hit, in_pieces_);
      if (found == WallEvents<R>::Found::failed) return events.outcome();
      if (found == WallEvents<R>::Found::stuck) return stays_on(hit.side);
      const bool is_hit = found == WallEvents<R>::Found::hit;
      if (const Outcome outcome = events.go_to(is_hit ? hit.part : R(1)); outcome != Outcome::done) return outcome;
      if (!is_hit) return Outcome::done;
      left -= hit.part * left;
      const std::size_t coordinate = walls_->sides[hit.side].coordinate;
      if (!events.reflect(coordinate)) return no_other_root(coordinate);
      parts_->forget();
      met_.push_back({hit.side, length - left});
      keep_state(met_.back());
      if (met_.size() > most_bounces) {
        why_ = "more than " + std::to_string(most_bounces) + " bounces in one step, the last off the wall of " +
               walls_->names[hit.side];
        return Outcome::wall;
      }
      if (left == R(0)) return Outcome::done;
    }
  }
  struct Met {
    std::size_t side = 0;
    R after{};  // the time at the start of the step
    V q{};
    V p{};
  };
  void keep_state(Met& met) const {
    if (!on_bounce_) return;
    met.q = parts_->present_positions();
    met.p = parts_->present_momenta();
  }

  /// Reports and counts the bounces of a completed step.
  void tell() {
    for (const Met& met : met_) {
      ++counts_[met.side];
      if (!on_bounce_) continue;
      const WallSide<R>& wall = walls_->sides[met.side];
      Bounce bounce;
      bounce.step = inner_->step();
      const bool located = walls_->rule == WallRule::event;
      const R end = parts_->present_time();
      const R time = located ? R(end - parts_->length_of_step() + met.after) : end;
      bounce.time = static_cast<double>(time);
      bounce.coordinate = wall.coordinate;
      bounce.side = wall.side;
      for (const R& x : met.q) bounce.q.push_back(static_cast<double>(x));
      for (const R& x : met.p) bounce.p.push_back(static_cast<double>(x));
      if constexpr (requires(const R& x) { written_digits(x); }) {
        bounce.digits.time = written_digits(time);
        for (const R& x : met.q) bounce.digits.q.push_back(written_digits(x));
        for (const R& x : met.p) bounce.digits.p.push_back(written_digits(x));
      }
      on_bounce_(bounce);
    }
    met_.clear();
  }

  /// Counts the iterations of a rejected or divided step, including discarded ones, as those of one step; each of its
  /// parts has counted itself as a step.
  void count_as_one(const Effort& before, const Effort& discarded_work_before) {
    const Effort now = inner_->effort();
    if (now.linear_solves == 0 && discarded_work_.linear_solves == 0) return;
    discarded_work_.steps += 1 - (now.steps - before.steps);
    discarded_work_.solves_max =
        std::max(discarded_work_.solves_max, now.linear_solves - before.linear_solves + discarded_work_.linear_solves -
                                                 discarded_work_before.linear_solves);
  }
  Outcome back_with(Outcome why) {
    parts_->restore_state(Place::step);
    met_.clear();
    return why;
  }
  Outcome no_other_root(std::size_t coordinate) {
    const auto wall = std::find_if(walls_->sides.begin(), walls_->sides.end(),
                                   [&](const WallSide<R>& side) { return side.coordinate == coordinate; });
    why_ = "at the wall of " + walls_->names[static_cast<std::size_t>(wall - walls_->sides.begin())] + " " +
           std::string(no_other_momentum);
    return Outcome::wall;
  }
  Outcome stays_on(std::size_t side) {
    why_ = "the motion stays on the wall of " + walls_->names[side] + " although it is reflected again and again";
    return Outcome::wall;
  }
  /// Explains a NaN by a soft wall. The failed step is repeated on a copy to see whether it reaches a wall, because a
  /// Newton iteration of an earlier step may have done so, too.
  Outcome explained(Outcome outcome) {
    if (!outside_ || (outcome != Outcome::non_finite && outcome != Outcome::not_converged)) return outcome;
    outside_.reset();
    (void)inner_->clone()->advance(1);
    if (!outside_) return outcome;
    why_ = walls_->names.at(*outside_) + " was on or beyond a soft wall";
    return Outcome::outside;
  }

  std::unique_ptr<Simulation> inner_;
  Parts* parts_;                   // the same
  RecordedMember* recorded_;       // the same; null if it is not recorded
  HasPartsInNumbers* in_numbers_;  // the same
  std::shared_ptr<const RunWalls<R>> walls_;
  bool has_own_substeps_;
  int order_;
  bool in_pieces_ = false;            // the present step is searched in pieces, whatever its ends look like
  std::vector<std::int64_t> counts_;  // bounces of each side
  Effort discarded_work_;             // work of the search for bounces and of rejected steps
  std::vector<Met> met_;              // bounces in the present step
  std::optional<BouncesInNumbers> bounces_in_numbers_;
  const RecordedStep* undone_ =
      nullptr;  // the next step, which may hit a wall and which the loop of recorded steps has left
  std::span<const NamedExpression> summed_{};  // their values after each step are added to sums_
  std::span<StepSum> sums_{};
  Frame frame_;
  std::string why_;
  std::optional<std::size_t> outside_;  // the interval of the soft wall that was reached
  std::function<void(const Bounce&)> on_bounce_;
};

/// A member of an ensemble. It takes the counts of recorded steps together with their values.
class WalledMember final : public WalledSimulation<double>, public RecordedMember {
 public:
  WalledMember(std::unique_ptr<Simulation> inner, std::shared_ptr<const RunWalls<double>> walls)
      : WalledSimulation<double>(std::move(inner), std::move(walls)) {}

  std::shared_ptr<const RecordedStep> recorded_step(AtWalls /*at_walls*/) override {
    if (recorded_ == nullptr) return nullptr;
    const auto step = walls_->in_steps ? recorded_->recorded_step(AtWalls::bounce) : nullptr;
    return step ? step : recorded_->recorded_step(AtWalls::stop);
  }
  /// Tangent vectors go through bounces one by one, not as a recorded step.
  std::shared_ptr<const RecordedStep> tangent_step(RecordedAt /*at*/) override { return nullptr; }
  void make_ready() override { recorded_->make_ready(); }
  bool read_values(const RecordedStep& step, std::span<double> values) const override {
    return recorded_->read_values(step, values);
  }
  void take_values(const RecordedStep& step, std::span<const double> values, std::int64_t steps) override {
    add_bounces(step, values, counts_);
    recorded_->take_values(step, values, steps);
  }
  Outcome step_ordinarily(const RecordedStep& undone) override {
    undone_ = &undone;
    const Outcome outcome = take_step();
    return outcome == Outcome::done ? outcome : explained(outcome);
  }
  double time_after(std::int64_t steps) const override { return recorded_->time_after(steps); }
};

}  // namespace

template <class R>
std::unique_ptr<Simulation> simulate_with_walls(const ErasedRun<R>& run, const Request& request, const Walls& walls,
                                                Simulate<R> simulate) {
  ErasedRun<R> other = run;
  auto behind = add_walls_to_run(other, request, walls);
  if constexpr (std::is_same_v<R, double>) {
    return std::make_unique<WalledMember>(simulate(other, request), std::move(behind));
  } else {
    return std::make_unique<WalledSimulation<R>>(simulate(other, request), std::move(behind));
  }
}

#define HAMFLOW_WITH_WALLS(R)                                                                                    \
  template std::unique_ptr<Simulation> simulate_with_walls<R>(const ErasedRun<R>&, const Request&, const Walls&, \
                                                              Simulate<R>);
HAMFLOW_WITH_WALLS(double)
HAMFLOW_WITH_WALLS(DoubleDouble)
HAMFLOW_WITH_WALLS(Quad)
HAMFLOW_WITH_WALLS(Mp)
#undef HAMFLOW_WITH_WALLS

}  // namespace hamflow
