// What an experiment has at hand: runs of scenarios, claims, curves and figures.
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

/// The samples of a run and what it came to.
struct Trajectory {
  std::vector<std::int64_t> step;
  std::vector<double> t;
  std::vector<std::vector<double>> q;  // q[k][i]: coordinate i of sample k
  std::vector<std::vector<double>> p;
  std::vector<double> energy;
  std::vector<std::vector<double>> invariants;  // all components of all invariants, of each sample
  // Of the step before each sample, where method.diagnostics asks for them; else, and of the start, not a number.
  std::vector<double> iterations;
  std::vector<double> condition_tangent;
  std::vector<double> determinant_tangent;
  std::vector<double> condition_inverse_mass;
  RunReport report;

  std::size_t size() const { return t.size(); }
  /// One coordinate, or momentum, at every sample.
  std::vector<double> coordinate(std::size_t i) const;
  std::vector<double> momentum(std::size_t i) const;
};

using Curves = ColumnGroup;

struct Drawn {
  std::string name;
  std::string caption;
  figures::Page page;
};

/// Rows of text beneath headings, for what is no curve.
struct TextTable {
  std::string name;
  std::string caption;
  std::vector<std::string> headings;
  std::vector<std::vector<std::string>> rows;
};

struct KeptScenario {
  std::string name;
  std::string text;
  std::string command = "run";  // of hamflow, which carries it out again
};

/// Ctrl-C: what is not done is done at the next time.
struct Stopped {};

class Study {
 public:
  /// @param folder of the experiment, in which long runs keep their checkpoints
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

  /// Runs a scenario and keeps its text under that name. Its samples are those that `run.record_every` asks for. A run
  /// of millions of steps has a folder of its own, NAME.run, from which it goes on after a kill.
  /// @param sets PATH=VALUE   @throws Error where the scenario is refused, another one has that name, or the run fails
  Trajectory run(const std::string& name, const std::string& toml, const std::vector<std::string>& sets = {});
  /// The same for an experiment that asks how far a run comes: one that fails says so in its report.
  Trajectory try_run(const std::string& name, const std::string& toml, const std::vector<std::string>& sets = {});

  /// There and back, and keeps the scenario's text under that name.
  /// @param sets PATH=VALUE   @throws Error where the scenario is refused; what fails says so in its report
  ReversalReport reverse(const std::string& name, const std::string& toml, const std::vector<std::string>& sets = {});

  struct Statement {
    std::string name;
    std::string statement;
    std::string printed;
    std::string page{};  // of the experiment, where empty
  };
  void claim(const Statement& statement, const Rule& rule, std::vector<Measured> measured,
             Grounds grounds = Grounds::program, const std::string& decided_by = {});
  void nothing_to_test(const std::string& name, const std::string& why);

  void keep(Curves curves) { curves_.push_back(std::move(curves)); }
  void table(TextTable table) { tables_.push_back(std::move(table)); }
  void draw(std::string name, std::string caption, figures::Page page) {
    drawn_.push_back({std::move(name), std::move(caption), std::move(page)});
  }
  /// A scenario that was carried out by other means than run(); once, where it is by that name and text already.
  /// @throws Error where another one has that name
  void keep_scenario(std::string name, std::string text, std::string command = "run");
  void note(std::string text) { notes_.push_back(std::move(text)); }
  /// Of work of the experiment's own, for what asks rather than being told.
  bool goes_on() const { return !go_on_ || go_on_(); }
  /// Between pieces of work of the experiment's own.   @throws Stopped
  void breathe() const {
    if (!goes_on()) throw Stopped{};
  }

  /// Pieces of work of the experiment's own that do not depend on each other, also on threads that have nothing else to
  /// do. No piece calls what keeps something here.
  void each(std::size_t count, const std::function<void(std::size_t)>& piece) const { others_.each(count, piece); }

  const std::vector<Claim>& claims() const { return claims_; }
  const std::vector<Curves>& curves() const { return curves_; }
  const std::vector<Drawn>& drawn() const { return drawn_; }
  const std::vector<TextTable>& tables() const { return tables_; }
  const std::vector<KeptScenario>& scenarios() const { return scenarios_; }
  const std::vector<std::string>& notes() const { return notes_; }

 private:
  /// @throws Error where another scenario has that name
  bool has_scenario(const std::string& name, const std::string& text, const std::string& command) const;
  /// @throws Error where it is refused
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
  std::vector<KeptScenario> scenarios_;
  std::vector<std::string> notes_;
};

}  // namespace hamflow::reproduction
