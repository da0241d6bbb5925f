// A scenario: everything that a run needs. It is read from TOML and checked before the run starts.
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
#include "hamflow/orbits/bodies.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/section.hpp"

namespace hamflow {

/// Value of a key and its position; line 0: given with --set.
struct Setting {
  std::string text;
  int line = 0;
  int column = 0;
};

/// A zero of an expression that a run locates, counts and records.
struct UserEvent {
  std::string name;
  Section zero;        // given as an expression with value 0
  bool stops = false;  // the run ends with the step of the event
};

/// Names of units, if the scenario has them.
struct UnitNames {
  std::string length;
  std::string time;
  std::string mass;
};

/// Orbital elements that are recorded with the samples.
struct RecordedElements {
  Primary primary = Primary::jacobi;
  std::size_t of = 0;  // the body that is the primary, for Primary::body
  std::vector<double> masses{};
  double gravitational_constant = 0;
};

struct Scenario {
  std::string file;  // file name as the user gave it
  std::string text;  // the scenario that is run: the text of the file with every --set merged in
  std::shared_ptr<const ProblemEntry> problem{};
  Request request;
  double dt = 0;
  std::int64_t steps = 0;
  std::int64_t record_every = 1;
  // times of samples, number expressions in the order of the run; empty: samples by steps
  std::vector<std::string> record;
  std::vector<std::int64_t> record_steps;  // steps from which the partial steps to these times are taken
  std::int64_t checkpoint_every = 0;       // in steps; 0: by wall time
  std::string folder;                      // empty: derived from the name of the file
  std::vector<std::string> formats{"h5"};
  std::vector<std::string> figures;
  std::vector<NamedExpression> observables;      // recorded with the samples
  std::optional<NamedExpression> hamiltonian{};  // H(q, p, t), recorded with the samples; only if H depends on t
  std::size_t lyapunov = 0;                      // number of exponents to measure
  bool eigenvalues = false;                      // measure the eigenvalues of the derivative of all steps
  std::optional<Section> section{};              // Poincare section to record
  std::vector<UserEvent> events;                 // declared by the user
  std::int64_t record_events = 100000;           // largest number of rows in each table of events
  bool map = false;                              // the steps are a map and do not approximate a flow
  bool certificate = true;                       // requested; a map has none
  std::vector<std::string> notes;                // remarks that are not errors
  std::optional<TwoBodies> bodies;               // if the start is given by two bodies in space
  std::vector<std::string> body_names;           // of bodies under gravity; empty: they have none
  UnitNames units;                               // empty: those of the input
  std::optional<RecordedElements> elements;      // nothing: not requested
  std::vector<double> start_q;                   // in double, canonical
  std::vector<double> start_p;
  std::optional<std::uint64_t> start_contents{};  // hash of the numbers, if the start is read from a file
  std::map<std::string, Setting> settings;        // every given key, by its dotted path
};

struct Reading {
  std::optional<Scenario> scenario;  // set if there are no complaints
  std::vector<Complaint> complaints;
  std::string no_start;                            // explains why no start has the requested energy or component
  std::optional<Scenario> scenario_without_start;  // scenario of a member of a sweep whose only error is no_start
};

/// @param sets PATH=VALUE texts that override the file   @throws FileError if the file cannot be read
Reading read_scenario(const std::filesystem::path& file, const std::vector<std::string>& sets);
/// The same for a text that was read already. Messages use `name` for the file.
Reading read_scenario_text(const std::string& text, const std::string& name, const std::vector<std::string>& sets);

/// Returns the text of a scenario file.   @throws FileError
std::string scenario_text(const std::string& file);

/// Returns the smallest spacing with at most 10^4 samples, including start and end.
std::int64_t default_record_every(std::int64_t steps, std::size_t coordinates = 0);
/// Returns the number of samples: the start, every `record_every`-th step, and the last one.
std::int64_t sample_count(std::int64_t steps, std::int64_t record_every);
/// Returns the number of samples of a scenario, by steps or at given times.
std::int64_t sample_count(const Scenario& scenario);

}  // namespace hamflow
