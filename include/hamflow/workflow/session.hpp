// Interactive run: step size, method and tolerance may change between steps, while state and time are kept. For
// observers and summaries a session is one simulation, from its start to its current state.
#pragma once

#include <filesystem>
#include <memory>

#include "hamflow/detail/verify/turning_points.hpp"
#include "hamflow/run/observer.hpp"
#include "hamflow/scenario/scenario.hpp"
#include "hamflow/workflow/summary.hpp"

namespace hamflow {

class Session final : public Simulation {
 public:
  /// @throws Error
  explicit Session(const Scenario& scenario);
  Session(const Session&) = delete;  // the simulation has a pointer to the session, to report bounces
  Session& operator=(const Session&) = delete;

  /// Returns to the start and keeps the current settings.
  void restart();
  /// Changes the step size, a number expression. @throws Error if it is 0 or not a number; then nothing has changed
  void set_step_size(const std::string& text);
  /// Changes the method. Options that are not given keep the value that they had when this method was used before.
  /// @throws Error if the method cannot be used here
  void set_method(const MethodSpec& method);
  /// Sets the tolerance of the method: a number expression, or "off" for its default.
  /// @throws Error if the method has no tolerance or does not allow this one
  void set_tolerance(const std::string& text);

  /// Returns the scenario with the current settings; its text has them, too.
  Scenario present() const;
  const Request& request() const { return request_; }
  /// Changes after the first step, in order.
  const std::vector<SessionChange>& changes() const { return changes_; }
  /// Whether momenta were negated. If so, the state is not on the orbit of the start at the session's time.
  bool reversed() const { return reversed_; }
  /// Bounces off hard walls, in order, at most as many as the scenario records.
  const std::vector<Bounce>& bounces() const { return bounces_; }

  /// Observer that finds steps that are too long. The caller runs it together with the other observers.
  TurningPointObserver& turns() { return turns_; }
  const TurningPointObserver& turns() const { return turns_; }

  Outcome advance(std::int64_t steps) override;
  std::int64_t step() const override;
  void look(Frame& frame) const override;
  void reverse_time() override;
  /// Time keeps increasing. Errors of the invariants are measured from their values after the call, energy errors from
  /// the start.
  void negate_momenta() override;
  std::vector<std::byte> bits() const override { return simulation_->bits(); }
  Excursion energy() const override;
  std::optional<ConstraintResiduals> constraints() const override;
  /// Restarts the range of the current part only.
  void restart_energy_range() override { simulation_->restart_energy_range(); }
  std::vector<InvariantExcursion> invariants() const override;
  Effort effort() const override;
  StepDiagnostics diagnostics() const override { return simulation_->diagnostics(); }
  MethodInfo method() const override { return describe(request_.method); }
  std::string failure() const override { return simulation_->failure(); }
  std::vector<WallCount> wall_counts() const override;
  /// A session cannot be saved or copied: these three throw Error.
  std::vector<std::byte> save() const override;
  void restore(std::span<const std::byte> saved) override;
  std::unique_ptr<Simulation> clone() const override;
  Outcome look_ahead(const std::string& time, Frame& frame) const override;
  Outcome look_part(double theta, Frame& frame) const override;

 private:
  void remember(const MethodSpec& method);
  void change(const Request& next, const std::string& what);
  void refuse_time(const std::string& what) const;
  void report_bounces();
  bool records_more_bounces() const;
  void watch_from_here();
  void watch(const Frame& frame);
  void in_session(Frame& frame) const;
  double deviation(const std::vector<double>& values, std::size_t k) const;

  Scenario scenario_;
  Request request_;  // with the current settings; after the first part, with the state in which the part began
  // simulation of the current part; its steps and times count from the start of the part
  std::unique_ptr<Simulation> simulation_;
  /// Last values of method options, each with its declaration, because families may use one name for different options.
  std::vector<std::pair<const OptionInfo*, std::string>> options_;
  std::vector<SessionChange> changes_;
  bool reversed_ = false;

  // True until the first change. The simulation measures energy errors of one part only; after a change watch()
  // measures them.
  bool one_part_ = true;
  std::int64_t step_before_ = 0;
  double time_before_ = 0;
  std::string exact_time_before_ = "0";  // in arithmetic with more digits than double
  Effort effort_before_;
  std::vector<WallCount> bounces_before_;
  std::vector<Bounce> bounces_;
  bool reports_bounces_ = false;  // the simulation reports its bounces to the session
  double initial_energy_ = 0;
  std::string exact_initial_energy_;  // all digits, in arithmetic with more digits than double
  Excursion first_part_;              // range of the energy in the first part
  double worst_energy_ = 0;
  std::optional<ConstraintResiduals> worst_residuals_;  // largest residuals before the current part
  std::vector<std::size_t> sizes_;                      // number of components of each invariant
  std::vector<double> initial_invariants_;              // values at the start
  std::vector<double> reference_;                       // values from which deviations are measured
  // corrects time-dependent invariants, because each part starts at t = 0
  std::vector<double> offset_;
  std::vector<double> worst_invariants_;  // one for each invariant
  Frame scratch_;
  TurningPointObserver turns_{0, false};
};

/// Keeps the start and every n-th step. When there are too many samples, every second one is dropped and n doubles.
class SampleKeeper final : public Observer {
 public:
  /// @param most largest number of samples; 0: as many as fit into about 100 megabytes
  SampleKeeper(std::int64_t every, std::size_t dimension, std::size_t most = 0);
  std::int64_t next_due(std::int64_t step) const override;
  Verdict observe(const Frame& frame) override;
  /// Returns the samples, including the current state.
  std::vector<Frame> with_current_state(const Simulation& simulation) const;
  void clear() { samples_.clear(); }
  std::int64_t every() const { return every_; }

 private:
  std::int64_t every_;
  std::size_t most_;
  std::vector<Frame> samples_;
};

/// Result of the last steps of a session.
struct SessionOutcome {
  Outcome outcome = Outcome::done;
  double wall_seconds = 0;  // over all steps
};

/// Returns the summary of a run, with the changes of settings.
Summary session_summary(const Session& session, const SessionOutcome& last);
/// Writes the samples so far into a folder, in the format of a run.
/// @param replace whether an existing folder is replaced   @throws FileError if it exists and `replace` is false, or it
/// cannot be written
void save_session(const Session& session, const SampleKeeper& samples, const SessionOutcome& last,
                  const std::filesystem::path& folder, bool replace);

}  // namespace hamflow
