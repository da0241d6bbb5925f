#include "step_control.hpp"

#include "hamflow/core/text.hpp"
#include "hamflow/run/socket.hpp"

namespace hamflow {

namespace {

const BoundOptions<StepControl>& control_options() {
  static const BoundOptions<StepControl> all{
      bind_word({.name = step_control_option,
                 .default_value = fixed_steps,
                 .meaning = "reversible: steps of varying size, for symmetric methods; dt is the size of the first "
                            "step, and the time is part of the state"},
                &StepControl::reversible, {{fixed_steps, false}, {reversible_steps, true}}),
      bind_word({.name = monitor_option,
                 .default_value = default_monitor,
                 .meaning = "what controls the step size: arclength gives steps of equal length in phase space; "
                            "distance gives steps proportional to the power 3/2 of the distance to the centre or "
                            "between the two closest bodies (central-force, n-body, solar-system)",
                 .condition = std::string("with ") + step_control_option + " = \"" + reversible_steps + "\""},
                &StepControl::monitor,
                {{default_monitor, default_monitor}, {distance_monitor_name, distance_monitor_name}})};
  return all;
}
bool declares(const MethodFamily& family) { return find_option(family.options, monitor_option) != nullptr; }

}  // namespace

StepControl step_control_of(const MethodSpec& method) {
  // Most methods have no step control, and the method of reference solutions is not in the list.
  if (!method.options.contains(step_control_option)) return {};
  return declares(*find_method(method.name).family) ? read_options(control_options(), method.options) : StepControl{};
}

void add_step_control(MethodFamily& family) {
  if (find_option(family.options, step_control_option) != nullptr) return;
  for (OptionInfo& option : declarations_of(control_options())) family.options.push_back(std::move(option));
}

std::optional<RefusedOption> refused_step_control(const MethodSpec& method) {
  const MethodEntry& entry = find_method(method.name);
  if (!declares(*entry.family)) return std::nullopt;
  const StepControl control = step_control_of(method);
  if (!control.reversible) {
    const auto monitor = method.options.find(monitor_option);
    if (monitor == method.options.end()) return std::nullopt;
    return RefusedOption{monitor_option, "found \"" + monitor->second +
                                             "\" with steps of equal size, which have no monitor; allowed with " +
                                             step_control_option + " = \"" + reversible_steps + "\""};
  }
  const MethodInfo info = entry.family->describe(entry.index, method.options);
  if (!info.symmetric) {
    return RefusedOption{step_control_option, std::string("found \"") + reversible_steps + "\" with " + info.name +
                                                  ", which is not symmetric; allowed " + fixed_steps +
                                                  ", or a symmetric method"};
  }
  if (info.diagnostics) {
    return RefusedOption{step_control_option, std::string("found \"") + reversible_steps +
                                                  "\" with diagnostics, which need steps of equal size; allowed " +
                                                  fixed_steps + ", or no diagnostics"};
  }
  return std::nullopt;
}

std::string refused_monitor(const MethodSpec& method, const ProblemEntry& problem) {
  const StepControl control = step_control_of(method);
  if (control.reversible && problem.info.name == SocketKeys::problem) {
    return std::string(step_control_option) + ": found \"" + reversible_steps + "\" for " + problem.info.name +
           "; allowed " + fixed_steps + ", because monitors need second derivatives, which a client does not send";
  }
  if (!control.reversible || control.monitor == default_monitor || problem.has_distance) return {};
  return std::string(monitor_option) + ": found \"" + control.monitor + "\" for " + problem.info.name +
         ", which has neither a centre nor bodies; allowed " + default_monitor +
         " (any H), or central-force, n-body, solar-system";
}

}  // namespace hamflow
