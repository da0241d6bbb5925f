// A scenario: everything a run needs, read from TOML and checked before anything runs.
#pragma once

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "hamflow/core/complaint.hpp"
#include "hamflow/detail/problems/two_bodies.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/section.hpp"

namespace hamflow {

/// What was given for a key, and where; line 0: with --set.
struct Setting {
  std::string text;
  int line = 0;
  int column = 0;
};

/// A zero of an expression that a run locates, counts and records.
struct UserEvent {
  std::string name;
  Section zero;        // by expression, with value 0
  bool stops = false;  // the run ends with that step
};

struct Scenario {
  std::string file;  // as named by the user
  std::string text;  // as it is carried out: the file's, or with each --set merged in; a scenario by itself
  std::shared_ptr<const ProblemEntry> problem{};
  Request request;
  double dt = 0;
  std::int64_t steps = 0;
  std::int64_t record_every = 1;
  std::vector<std::string> record;  // times of samples, number expressions in the order of the run; none: by steps
  std::vector<std::int64_t> record_steps;  // from which the partial steps to them are taken
  std::int64_t checkpoint_every = 0;       // steps; 0: by the clock
  std::string folder;                      // empty: derived from the file's name
  std::vector<std::string> formats{"h5"};
  std::vector<std::string> figures;
  std::vector<NamedExpression> observables;      // recorded with the samples
  std::optional<NamedExpression> hamiltonian{};  // H(q, p, t) itself, recorded with the samples, where it depends on t
  std::size_t lyapunov = 0;                      // exponents to be measured
  bool eigenvalues = false;                      // of the derivative of all steps
  std::optional<Section> section{};              // whose points are recorded
  std::vector<UserEvent> events;                 // declared by the user
  std::int64_t record_events = 100000;           // rows of each table of events, at most
  bool map = false;                              // the steps are those of a map and approximate no flow
  bool certificate = true;                       // asked for; a map has none
  std::vector<std::string> notes;                // worth saying, but no errors
  std::optional<TwoBodies> bodies;               // of a start by two bodies in space
  std::vector<double> start_q;                   // in double, canonical
  std::vector<double> start_p;
  std::optional<std::uint64_t> start_contents{};  // of a start that stands in a file: a hash of its numbers
  std::map<std::string, Setting> settings;        // every key that was given, by its dotted path
};

struct Reading {
  std::optional<Scenario> scenario;  // set when there is nothing to complain about
  std::vector<Complaint> complaints;
  std::string no_start;               // why no start has the energy, or the component, that was asked for
  std::optional<Scenario> startless;  // of a sweep's member, where that is all that is wrong with it
};

/// @param sets PATH=VALUE texts that override the file   @throws FileError when the file cannot be read
Reading read_scenario(const std::filesystem::path& file, const std::vector<std::string>& sets);
/// The same for a text that was read already; `name` stands in messages.
Reading read_scenario_text(const std::string& text, const std::string& name, const std::vector<std::string>& sets);

/// The text of a scenario file.   @throws FileError
std::string scenario_text(const std::string& file);

/// The smallest spacing of samples, start and end included, that keeps at most 10^4 of them.
std::int64_t default_record_every(std::int64_t steps, std::size_t coordinates = 0);
/// Samples kept: the start, every `record_every`-th step, and the last.
std::int64_t sample_count(std::int64_t steps, std::int64_t record_every);
/// Those at given times, where there are any.
std::int64_t sample_count(const Scenario& scenario);

}  // namespace hamflow
