#include "run_keys.hpp"

#include <algorithm>

#include "figure_kinds.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/socket.hpp"

namespace hamflow {

const LatticeKeys& lattice_keys() {
  static const LatticeKeys keys{
      .position = {.name = "position",
                   .meaning = "spacing of positions, a power of two from 2^-1000 to 2^999",
                   .range = Range::positive,
                   .unset = "2^-52 of the largest position at the start",
                   .example = "2^-52"},
      .momentum = {.name = "momentum",
                   .meaning = "spacing of momenta, a power of two from 2^-1000 to 2^999",
                   .range = Range::positive,
                   .unset = "2^-52 of the largest momentum at the start (for attracting bodies, of the largest "
                            "expected momentum); larger for a gas of more than 1023 particles",
                   .example = "2^-52"}};
  return keys;
}

const SectionKeys& section_keys() {
  static const SectionKeys keys{
      .coordinate = {.name = "coordinate",
                     .meaning = "the coordinate or momentum that defines the section",
                     .type = OptionType::word,
                     .unset = "the expression",
                     .condition = "exactly one of coordinate, expression"},
      .expression = {.name = "expression",
                     .meaning = "an expression of coordinates, momenta, parameters and t that defines the section",
                     .type = OptionType::text,
                     .unset = "the coordinate",
                     .condition = "in place of coordinate",
                     .example = "q1 - q2"},
      .value = {.name = "value",
                .default_value = "0",
                .meaning = "value of the coordinate or expression on the section"},
      .direction = {.name = "direction",
                    .default_value = "1",
                    .meaning = "direction of the crossing: 1 increasing, -1 decreasing, 0 both",
                    .range = Range::whole_from(-1, 1)}};
  return keys;
}

const EventKeys& event_keys() {
  static const EventKeys keys{
      .name = {.name = "name",
               .meaning = "name of the event",
               .type = OptionType::text,
               .unset = "event1, event2, ...",
               .example = "event1"},
      .expression = {.name = "expression",
                     .meaning = "an expression of coordinates, momenta, parameters and t; its zeros are the events",
                     .type = OptionType::text,
                     .required = true,
                     .example = "q1 - q2"},
      .direction = {.name = "direction",
                    .default_value = "1",
                    .meaning = "direction of the crossing: 1 increasing, -1 decreasing, 0 both",
                    .range = Range::whole_from(-1, 1)},
      .action = {.name = "action",
                 .default_value = "record",
                 .meaning = "record the event, or stop the run after the step of the event",
                 .type = OptionType::word,
                 .words = {"record", "stop"}}};
  return keys;
}

const RunKeys& run_keys() {
  static const RunKeys keys{
      .dt = {.name = "dt",
             .meaning = "step size; negative: backward in time",
             .range = {.not_zero = true},
             .required = true,
             .unit = "time",
             .example = "0.1"},
      .steps = {.name = "steps",
                .meaning = "number of steps",
                .range = Range::whole_from(0, static_cast<double>(most_steps)),
                .condition = "exactly one of steps, t_end",
                .example = "1000",
                .free_on_resume = true},
      .t_end = {.name = "t_end",
                .meaning = "final time, a whole multiple of dt",
                .unit = "time",
                .condition = "in place of steps",
                .example = "100",
                .free_on_resume = true},
      .record_every = {.name = "record_every",
                       .meaning = "number of steps between samples",
                       .range = Range::whole_from(1, static_cast<double>(most_steps)),
                       .unset = "chosen so that at most 10000 samples and 1 GiB are written",
                       .example = "1"},
      .record = {.name = "record",
                 .meaning = "times of the samples, in the order of the run; they may lie between steps",
                 .type = OptionType::list,
                 .unset = "samples by steps",
                 .unit = "time",
                 .condition = "in place of record_every",
                 .example = "[0, 0.15]"},
      .checkpoint_every = {.name = "checkpoint_every",
                           .meaning = "number of steps between checkpoints",
                           .range = Range::whole_from(1, static_cast<double>(most_steps)),
                           .unset = "every 10 seconds",
                           .example = "1000000",
                           .free_on_resume = true},
      .arithmetic = {.name = "arithmetic",
                     .default_value = arithmetics().front(),
                     .meaning = "number type of the computation; mp(d) has d = 2 to 100000 decimal digits",
                     .type = OptionType::word,
                     .words = arithmetics()},
      .functions = {.name = "functions",
                    .default_value = "system",
                    .meaning = "exp, sin, ... of doubles: of the system's library, or portable, with the same bits on "
                               "every machine and in the laboratory, which always uses them",
                    .type = OptionType::word,
                    .words = {"system", "portable"},
                    .condition = "with double, compensated, lattice"},
      .lattice = {.name = "lattice",
                  .meaning = "grid spacing of positions and momenta",
                  .type = OptionType::table,
                  .unset = "the defaults of its keys",
                  .condition = "with arithmetic = \"lattice\"",
                  .keys = {lattice_keys().position, lattice_keys().momentum}},
      .threads = {.name = "threads",
                  .default_value = "1",
                  .meaning = "number of threads for the forces of one step; does not change results",
                  .range = Range::whole_from(1, most_threads),
                  .condition = "more than 1 for bodies with arithmetic = \"lattice\", and for the gas in double",
                  .example = "2",
                  .free_on_resume = true},
      .lyapunov = {.name = "lyapunov",
                   .default_value = "false",
                   .meaning = "measure Lyapunov exponents: true for all, or the number of the largest ones",
                   .range = Range::whole_from(1, static_cast<double>(most_steps)),
                   .words = {"true", "false"},
                   .condition = "in double",
                   .example = "true"},
      .eigenvalues = {.name = "eigenvalues",
                      .default_value = "false",
                      .meaning = "compute the eigenvalues of the derivative of all steps",
                      .type = OptionType::yes_no,
                      .condition = "in double",
                      .example = "true"},
      .section = {.name = "section",
                  .meaning = "record a Poincare section",
                  .type = OptionType::table,
                  .unset = "none",
                  .keys = {section_keys().coordinate, section_keys().expression, section_keys().value,
                           section_keys().direction}},
      .events = {.name = "events",
                 .meaning = "locate and count zeros of expressions, [{ name, expression, direction, action }]",
                 .type = OptionType::table,
                 .unset = "none",
                 .keys = {event_keys().name, event_keys().expression, event_keys().direction, event_keys().action}},
      .record_events = {.name = "record_events",
                        .default_value = "100000",
                        .meaning = "largest number of rows in each table of events; later events are only counted",
                        .range = Range::whole_from(0, static_cast<double>(most_steps)),
                        .example = "1000"},
      .map = {.name = "map",
              .default_value = "false",
              .meaning = "treat the method as a map, not as an approximation of a flow: no warnings, certificate or "
                         "energy scale; sections, events and Lyapunov exponents count steps instead of time",
              .type = OptionType::yes_no,
              .condition = "with steps of equal size and without record",
              .example = "true"},
      .certificate = {.name = "certificate",
                      .default_value = "true",
                      .meaning = "judge the energy error and test the reversibility on a part of the run, which takes "
                                 "additional steps",
                      .type = OptionType::yes_no,
                      .example = "false"}};
  return keys;
}

const OutputKeys& output_keys() {
  static const OutputKeys keys{.folder = {.name = "folder",
                                          .meaning = "output directory",
                                          .type = OptionType::text,
                                          .unset = "the name of the scenario file without .toml, plus .run",
                                          .example = "my.run",
                                          .free_on_resume = true},
                               .formats = {.name = "formats",
                                           .default_value = "[h5]",
                                           .meaning = "file formats of the samples",
                                           .type = OptionType::word_list,
                                           .words = {"h5", "csv"},
                                           .example = "[h5]"},
                               .figures = {.name = "figures",
                                           .default_value = "[]",
                                           .meaning = "figures to draw at the end of the run",
                                           .type = OptionType::word_list,
                                           .words = figure_names(),
                                           .condition = "with the format h5",
                                           .example = "[energy-error]",
                                           .free_on_resume = true},
                               .observables = {.name = "observables",
                                               .meaning = "named expressions, { theta = \"atan2(y, x)\" }, which are "
                                                          "recorded with every sample and averaged over every step",
                                               .type = OptionType::table,
                                               .unset = "none",
                                               .example = "{ square = \"q1^2\" }"},
                               .elements = {.name = "elements",
                                            .meaning = "orbital elements of bodies, recorded with every sample as "
                                                       "Jupiter.a, Jupiter.e, ...: about the centre of mass of the "
                                                       "bodies before each (jacobi), of all (barycentre), or a body",
                                            .type = OptionType::text,
                                            .unset = "none",
                                            .condition = "for n-body and solar-system",
                                            .example = "jacobi"}};
  return keys;
}

const std::vector<DeclaredTable>& declared_tables() {
  static const std::vector<DeclaredTable> tables = [] {
    const RunKeys& r = run_keys();
    const OutputKeys& o = output_keys();
    return std::vector<DeclaredTable>{
        {run_table,
         {r.dt, r.steps, r.t_end, r.record_every, r.record, r.lyapunov, r.eigenvalues, r.section, r.events,
          r.record_events, r.map, r.certificate, r.checkpoint_every, r.arithmetic, r.functions, r.lattice, r.threads}},
        {output_table, {o.folder, o.formats, o.figures, o.observables, o.elements}}};
  }();
  return tables;
}

const DeclaredTable& declared_table(const std::string& name) {
  return *std::find_if(declared_tables().begin(), declared_tables().end(),
                       [&](const DeclaredTable& table) { return table.name == name; });
}

bool is_free_on_resume(const std::string& path) {
  return std::any_of(declared_tables().begin(), declared_tables().end(),
                     [&](const DeclaredTable& table) {
                       return std::any_of(table.keys.begin(), table.keys.end(), [&](const OptionInfo& key) {
                         return key.free_on_resume && path == table.name + "." + key.name;
                       });
                     }) ||
         std::any_of(socket_options().begin(), socket_options().end(),
                     [&](const OptionInfo& key) { return key.free_on_resume && path == "problem." + key.name; });
}

}  // namespace hamflow
