// Declares the keys of [run] and [output], each once. The reader, `new`, `show`, --resume and docs/reference.md use
// these declarations. Code that has to name a key takes the name from here.
#pragma once

#include <cstdint>
#include <vector>

#include "hamflow/detail/core/option_info.hpp"

namespace hamflow {

inline constexpr std::int64_t most_steps = std::int64_t{1} << 53;  // n has to be exact in double, so that t = n h is

/// Keys of `run.lattice`.
struct LatticeKeys {
  OptionInfo position, momentum;
};
/// Keys of `run.section`. The problem defines the allowed words of `coordinate`.
struct SectionKeys {
  OptionInfo coordinate, expression, value, direction;
};
/// Keys of each entry of `run.events`.
struct EventKeys {
  OptionInfo name, expression, direction, action;
};
struct RunKeys {
  OptionInfo dt, steps, t_end, record_every, record, checkpoint_every, arithmetic, functions, lattice, threads,
      lyapunov, eigenvalues, section, events, record_events, map, certificate;
};
struct OutputKeys {
  OptionInfo folder, formats, figures, observables, elements;
};

const LatticeKeys& lattice_keys();
const SectionKeys& section_keys();
const EventKeys& event_keys();
const RunKeys& run_keys();
const OutputKeys& output_keys();

inline constexpr const char* run_table = "run";
inline constexpr const char* output_table = "output";

/// A table of a scenario with all its keys, in the order in which they are shown.
struct DeclaredTable {
  std::string name;
  std::vector<OptionInfo> keys;
};
/// Returns [run] and [output].
const std::vector<DeclaredTable>& declared_tables();
const DeclaredTable& declared_table(const std::string& name);
/// Returns the dotted path of a key of [run] or [output], as in --set.
inline std::string run_path(const OptionInfo& key) { return std::string(run_table) + "." + key.name; }
inline std::string output_path(const OptionInfo& key) { return std::string(output_table) + "." + key.name; }
/// Returns whether a key, for example "run.steps", may have another value with --resume.
bool is_free_on_resume(const std::string& path);

}  // namespace hamflow
