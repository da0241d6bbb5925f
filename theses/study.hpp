// The interface for experiments: they run scenarios, and add claims, curves and figures.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "claim.hpp"
#include "hamflow/figures/page.hpp"
#include "hamflow/workflow/columns_file.hpp"
#include "hamflow/workflow/reverse.hpp"
#include "reproduce.hpp"
#include "shared_work.hpp"

namespace hamflow::reproduction {

/// The samples and the report of a run.
struct Trajectory {
  std::vector<std::int64_t> step;
  std::vector<double> t;
  std::vector<std::vector<double>> q;  // q[k][i]: coordinate i of sample k
  std::vector<std::vector<double>> p;
  std::vector<double> energy;
  std::vector<std::vector<double>> invariants;  // invariants[k]: all components of all invariants at sample k
  // Diagnostics of the step before each sample. They are NaN at the start, and without method.diagnostics.
  std::vector<double> iterations;
  std::vector<double> condition_tangent;
  std::vector<double> determinant_tangent;
  std::vector<double> condition_inverse_mass;
  RunReport report;

  std::size_t size() const { return t.size(); }
  /// Returns one coordinate, or one momentum, at every sample.
  std::vector<double> coordinate(std::size_t i) const;
  std::vector<double> momentum(std::size_t i) const;
};

using Curves = ColumnGroup;

struct Drawn {
  std::string name;
  std::string caption;
  figures::Page page;
};

/// A table of texts with headings.
struct TextTable {
  std::string name;
  std::string caption;
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
};

struct StoredScenario {
  std::string name;
  std::string text;
  std::string command = "run";  // the command of hamflow that repeats it
};

/// Thrown after Ctrl-C. The next reproduction with --resume runs what is missing.
struct StudyInterrupted {};

class Study {
 public:
  /// @param go_on returns false to stop   @param folder the folder of the experiment, also for checkpoints of long runs
  Study(ExperimentInfo info, WorkExtent extent, std::function<bool()> go_on, std::filesystem::path folder,
        SharedWork& others)
      : info_(std::move(info)),
        extent_(extent),
        go_on_(std::move(go_on)),
        folder_(std::move(folder)),
        others_(others) {}

  template <class T>
  T sized(T quick, T usual, T full) const {
    return extent_ == WorkExtent::quick ? quick : extent_ == WorkExtent::usual ? usual : full;
  }
  const ExperimentInfo& info() const { return info_; }
  const std::filesystem::path& folder() const { return folder_; }

  /// Runs a scenario and stores its text under `name`. Samples are taken every `run.record_every` steps. A run of
  /// millions of steps has a separate folder, NAME.run, from which it resumes after the program was killed.
  /// @param sets PATH=VALUE
  /// @throws Error if the scenario is wrong, if another scenario has this name, or if the run fails
  Trajectory run(const std::string& name, const std::string& toml, const std::vector<std::string>& sets = {});
  /// As run(), but a run that fails returns its samples, and its report says why. For experiments that measure how long
  /// a run succeeds.
  Trajectory try_run(const std::string& name, const std::string& toml, const std::vector<std::string>& sets = {});

  /// Makes a reversal and stores the text of the scenario under `name`. If the reversal fails, its report says why.
  /// @param sets PATH=VALUE   @throws Error if the scenario is wrong
  ReversalReport reverse(const std::string& name, const std::string& toml, const std::vector<std::string>& sets = {});

  struct Statement {
    std::string name;
    std::string statement;
    std::string printed;
    std::string page{};  // empty: the page of the experiment
  };
  void claim(const Statement& statement, const Rule& rule, std::vector<Measured> measured,
             Grounds grounds = Grounds::program, const std::string& decided_by = {});
  void nothing_to_test(const std::string& name, const std::string& why);

  void keep(Curves curves) { curves_.push_back(std::move(curves)); }
  void table(TextTable table) { tables_.push_back(std::move(table)); }
  void draw(std::string name, std::string caption, figures::Page page) {
    drawn_.push_back({std::move(name), std::move(caption), std::move(page)});
  }
  /// Stores a scenario that was not run with run(). The same scenario may be stored again.
  /// @throws Error if another scenario has this name
  void keep_scenario(std::string name, std::string text, std::string command = "run");
  void note(std::string text) { notes_.push_back(std::move(text)); }
  /// Returns false if the program has to stop.
  bool goes_on() const { return !go_on_ || go_on_(); }
  /// Experiments call this between parts of their own computations.   @throws Stopped if the program has to stop
  void breathe() const {
    if (!goes_on()) throw StudyInterrupted{};
  }

  /// Calls piece(0) to piece(count - 1), also on idle threads. Pieces are independent, and do not change this Study.
  void each(std::size_t count, const std::function<void(std::size_t)>& piece) const { others_.each(count, piece); }

  const std::vector<Claim>& claims() const { return claims_; }
  const std::vector<Curves>& curves() const { return curves_; }
  const std::vector<Drawn>& drawn() const { return drawn_; }
  const std::vector<TextTable>& tables() const { return tables_; }
  const std::vector<StoredScenario>& scenarios() const { return scenarios_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  /// @throws Error if another scenario has this name
  bool has_scenario(const std::string& name, const std::string& text, const std::string& command) const;
  /// @throws Error if the scenario is wrong
  Scenario read(const std::string& name, const std::string& toml, const std::vector<std::string>& sets) const;

  ExperimentInfo info_;
  WorkExtent extent_;
  std::function<bool()> go_on_;
  std::filesystem::path folder_;
  SharedWork& others_;
  std::vector<Claim> claims_;
  std::vector<Curves> curves_;
  std::vector<Drawn> drawn_;
  std::vector<TextTable> tables_;
  std::vector<StoredScenario> scenarios_;
  std::vector<std::string> notes_;
};

}  // namespace hamflow::reproduction
