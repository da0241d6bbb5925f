// A run that is steered on its way: step length, method and tolerance change, the state and the time go on. To
// observers and summaries a session is one simulation, from its start to its present state.
#pragma once

#include <filesystem>
#include <memory>

#include "hamflow/detail/verify/turns.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/workflow/summary.hpp"

namespace hamflow {

class Session final : public Simulation {
 public:
  /// @throws Error
  explicit Session(const Scenario& scenario);
  Session(const Session&) = delete;  // its simulation tells it of bounces
  Session& operator=(const Session&) = delete;

  /// With the present settings from the start again.
  void restart();
  /// Another step length, a number expression. @throws Error when it is 0 or no number; then nothing has changed
  void set_step_length(const std::string& text);
  /// Another method; of its options those that are not given are as they were set before, if they ever were.
  /// @throws Error when it cannot run here
  void set_method(const MethodSpec& method);
  /// The tolerance of the method, a number expression, or "off" for the one that it has by itself.
  /// @throws Error when it has none, or not this one
  void set_tolerance(const std::string& text);

  /// The scenario with the present settings, its text included.
  Scenario present() const;
  const Request& request() const { return request_; }
  /// What was changed after the first step, in order.
  const std::vector<SessionChange>& changes() const { return changes_; }
  /// Whether momenta were negated: the state is then not on the orbit of the start at the session's time.
  bool reversed() const { return reversed_; }
  /// Off hard walls, in order; as many as the scenario has recorded at most.
  const std::vector<Bounce>& bounces() const { return bounces_; }

  /// Watches for steps that are too long: whoever runs the session wakes it with the other observers.
  TurnWatch& turns() { return turns_; }
  const TurnWatch& turns() const { return turns_; }

  Outcome advance(std::int64_t steps) override;
  std::int64_t step() const override;
  void look(Frame& frame) const override;
  void reverse_time() override;
  /// Time goes on. Deviations of the invariants count from their values afterwards, those of the energy from the start.
  void negate_momenta() override;
  std::vector<std::byte> bits() const override { return simulation_->bits(); }
  Excursion energy() const override;
  std::optional<ConstraintResiduals> constraints() const override;
  /// Of the present part.
  void restart_energy_range() override { simulation_->restart_energy_range(); }
  std::vector<InvariantExcursion> invariants() const override;
  Effort effort() const override;
  StepDiagnostics diagnostics() const override { return simulation_->diagnostics(); }
  MethodInfo method() const override { return describe(request_.method); }
  std::string failure() const override { return simulation_->failure(); }
  std::vector<WallCount> wall_counts() const override;
  /// A session has no checkpoint and no copy: these three throw Error.
  std::vector<std::byte> save() const override;
  void restore(std::span<const std::byte> saved) override;
  std::unique_ptr<Simulation> clone() const override;
  Outcome look_ahead(const std::string& time, Frame& frame) const override;
  Outcome look_part(double theta, Frame& frame) const override;

 private:
  void remember(const MethodSpec& method);
  void change(const Request& next, const std::string& what);
  void refuse_time(const std::string& what) const;
  void listen();
  bool wants_bounces() const;
  void watch_from_here();
  void watch(const Frame& frame);
  void in_session(Frame& frame) const;
  double deviation(const std::vector<double>& values, std::size_t k) const;

  Scenario scenario_;
  Request request_;  // with the present settings; of a later part, with the state in which it began
  std::unique_ptr<Simulation> simulation_;  // the present part; its steps and times count from where the part began
  /// Of methods, as they were set last, each with its declaration: another family may mean something else by a name.
  std::vector<std::pair<const OptionInfo*, std::string>> options_;
  std::vector<SessionChange> changes_;
  bool reversed_ = false;

  // Until the first change the simulation's own probe watches; it knows only its own part. Then watch() does.
  bool one_part_ = true;
  std::int64_t step_before_ = 0;
  double time_before_ = 0;
  std::string exact_time_before_ = "0";  // beyond double
  Effort effort_before_;
  std::vector<WallCount> bounces_before_;
  std::vector<Bounce> bounces_;
  bool listens_ = false;  // to bounces
  double initial_energy_ = 0;
  std::string exact_initial_energy_;  // beyond double, with all its digits
  Excursion first_part_;              // of the energy
  double worst_energy_ = 0;
  std::optional<ConstraintResiduals> worst_residuals_;  // before the present part
  std::vector<std::size_t> sizes_;                      // of the invariants
  std::vector<double> initial_invariants_;              // at the start
  std::vector<double> reference_;                       // from which deviations count
  std::vector<double> offset_;                          // of invariants with time in them, whose parts begin at time 0
  std::vector<double> worst_invariants_;                // one for each invariant
  Frame scratch_;
  TurnWatch turns_{0, false};
};

/// Keeps the start, every n-th step and, after keep(), the present one. When they become too many every second one is
/// dropped and n doubles.
class SampleKeeper final : public Observer {
 public:
  /// @param most 0: as many as some 100 megabytes hold
  SampleKeeper(std::int64_t every, std::size_t dimension, std::size_t most = 0);
  std::int64_t next_due(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;
  /// The samples, the present state among them.
  std::vector<Frame> with_present(const Simulation& simulation) const;
  void clear() { samples_.clear(); }
  std::int64_t every() const { return every_; }

 private:
  std::int64_t every_;
  std::size_t most_;
  std::vector<Frame> samples_;
};

/// What the last steps of a session came to.
struct SessionOutcome {
  Outcome outcome = Outcome::done;
  double wall_seconds = 0;  // of all steps
};

/// That of a run, and what was changed on the way.
Summary session_summary(const Session& session, const SessionOutcome& last);
/// Writes what was sampled so far, as a run leaves it.
/// @param replace an existing folder   @throws FileError when it exists and `replace` is false, or cannot be written
void save_session(const Session& session, const SampleKeeper& samples, const SessionOutcome& last,
                  const std::filesystem::path& folder, bool replace);

}  // namespace hamflow
