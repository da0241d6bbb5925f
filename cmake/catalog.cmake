# The catalogue is the folders: every file of problems/, problems/of_any_size/, problems/potentials/, problems/pairs/, methods/compositions/,
# methods/splittings/, methods/force_gradient/, methods/tableaus/ and src/methods/families/ is found here, and gets its line
# in the generated lists (problems: a translation unit each). Adding one is adding a file. By convention problems/henon_heiles.hpp defines
# the class template HenonHeiles, compositions/stv4.hpp the table compositions::stv4, families/runge_kutta.hpp the class
# families::RungeKutta.

function(hamflow_names out folder)
  file(GLOB files CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/include/hamflow/${folder}/*.hpp")
  set(names)
  foreach(file IN LISTS files)
    get_filename_component(name "${file}" NAME_WE)
    list(APPEND names ${name})
  endforeach()
  list(SORT names)
  set(${out} ${names} PARENT_SCOPE)
endfunction()

# The same for a catalogue of a few problems and potentials: HAMFLOW_PROBLEMS, the names of their files; empty: all.
function(hamflow_chosen_names out folder)
  hamflow_names(names ${folder})
  if(HAMFLOW_PROBLEMS)
    set(present ${names})
    foreach(name IN LISTS present)
      if(NOT name IN_LIST HAMFLOW_PROBLEMS)
        list(REMOVE_ITEM names ${name})
      endif()
    endforeach()
  endif()
  set(${out} ${names} PARENT_SCOPE)
endfunction()

function(hamflow_pascal_case out snake)
  string(REPLACE "_" ";" words "${snake}")
  set(result "")
  foreach(word IN LISTS words)
    string(SUBSTRING "${word}" 0 1 head)
    string(SUBSTRING "${word}" 1 -1 tail)
    string(TOUPPER "${head}" head)
    string(APPEND result "${head}${tail}")
  endforeach()
  set(${out} "${result}" PARENT_SCOPE)
endfunction()

# Writes the two units of the problem in `header`, typed and behind virtual calls, and their declarations and calls to the lists; erased_units
# is the list that gets the second.
macro(hamflow_problem_unit name body erased_units)
  set(unit "${generated}/problem_${name}.cpp")
  set(unit_header problems/problem_unit)
  set(unit_class ProblemUnit)
  set(unit_entry TypedEntry)
  set(entry entry)
  file(CONFIGURE OUTPUT "${unit}" CONTENT "${body}" @ONLY)
  list(APPEND HAMFLOW_UNITS "${unit}")
  set(unit "${generated}/erased_${name}.cpp")
  set(unit_header problems/erased_unit)
  set(unit_class ErasedUnit)
  set(unit_entry ErasedEntry)
  set(entry erased)
  file(CONFIGURE OUTPUT "${unit}" CONTENT "${body}" @ONLY)
  list(APPEND ${erased_units} "${unit}")
  string(APPEND declarations "TypedEntry entry_${name}();\nErasedEntry erased_${name}();\n")
  string(APPEND problem_calls "joined(entry_${name}(), erased_${name}()), ")
  string(APPEND erased_calls "erased_${name}(), ")
endmacro()

set(generated "${PROJECT_BINARY_DIR}/generated")
set(HAMFLOW_UNITS)
set(HAMFLOW_ERASED_UNITS)
set(declarations "")
set(problem_calls "")
set(erased_calls "")
set(also "")
set(unit_text [[
#include "@unit_header@.hpp"
#include "hamflow/problems/@header@.hpp"
@also@namespace hamflow {
// The alias has a name of its own: two units with one name for different problems would be merged by the linker.
template <class R>
using @entry@Family_@name@ = @family@;
@unit_entry@ @entry@_@name@();
@unit_entry@ @entry@_@name@() { return @unit_class@<@entry@Family_@name@>::entry(); }
}  // namespace hamflow
]])

# Problems of few coordinates are recorded, so that what is behind virtual calls may be compiled with less optimisation. The force
# of problems of any size is worth its optimisation everywhere.
hamflow_chosen_names(problem_names problems)
hamflow_chosen_names(names_of_any_size problems/of_any_size)
list(APPEND problem_names ${names_of_any_size})
list(SORT problem_names)
foreach(name IN LISTS problem_names)
  hamflow_pascal_case(type ${name})
  set(family "${type}<R>")
  if(name IN_LIST names_of_any_size)
    set(header of_any_size/${name})
    hamflow_problem_unit(${name} "${unit_text}" HAMFLOW_UNITS)
  else()
    set(header ${name})
    hamflow_problem_unit(${name} "${unit_text}" HAMFLOW_ERASED_UNITS)
  endif()
endforeach()
hamflow_chosen_names(potential_names problems/potentials)
set(also "#include \"hamflow/problems/support/polar.hpp\"\n")
foreach(potential IN LISTS potential_names)
  hamflow_pascal_case(type ${potential})
  set(name central_force_${potential})
  set(header potentials/${potential})
  set(family "CentralForce<R, ${type}>")
  hamflow_problem_unit(${name} "${unit_text}" HAMFLOW_ERASED_UNITS)
  set(name polar_${potential})
  set(family "PolarCentralForce<R, ${type}>")
  hamflow_problem_unit(${name} "${unit_text}" HAMFLOW_ERASED_UNITS)
endforeach()

# Pair laws are alternatives of one type, so that each of them is compiled with the gas once.
hamflow_names(pair_names problems/pairs)
set(pair_includes "")
set(pair_types "")
set(pair_infos "")
foreach(name IN LISTS pair_names)
  hamflow_pascal_case(type ${name})
  string(APPEND pair_includes "#include \"hamflow/problems/pairs/${name}.hpp\"\n")
  string(APPEND pair_types "pairs::${type}<R>, ")
  string(APPEND pair_infos "pairs::${type}<double>::info(), ")
endforeach()
file(CONFIGURE OUTPUT "${generated}/pair_list.hpp" CONTENT [[
#pragma once
#include <variant>
@pair_includes@#include "gas/pair_laws.hpp"
#include "gas/typed_pair.hpp"
namespace hamflow {
template <class R>
using PairLaws = std::variant<@pair_types@TypedPair<R>>;
inline std::vector<ProblemInfo> built_in_pairs() { return {@pair_infos@}; }
/// The built-in law of that name.
template <class R>
PairLaws<R> make_pair_law(const std::string& name, const Parameters<R>& given) {
  return detail::make_pair_law_of<PairLaws<R>>(name, given);
}
}  // namespace hamflow
]] @ONLY)

set(includes "")
macro(hamflow_table_list kind out)
  hamflow_names(names methods/${kind})
  set(${out} "")
  foreach(name IN LISTS names)
    string(APPEND includes "#include \"hamflow/methods/${kind}/${name}.hpp\"\n")
    string(APPEND ${out} "&${kind}::${name}, ")
  endforeach()
endmacro()
hamflow_table_list(compositions composition_list)
hamflow_table_list(splittings splitting_list)
hamflow_table_list(force_gradient force_gradient_list)
hamflow_table_list(tableaus tableau_addresses)
hamflow_names(tableau_names methods/tableaus)
set(tableau_macro "")
foreach(name IN LISTS tableau_names)
  string(APPEND tableau_macro " X(${name})")
endforeach()

file(CONFIGURE OUTPUT "${generated}/catalog_tables.hpp" CONTENT [[
#pragma once
#include <vector>
#include "hamflow/methods/force_gradient.hpp"
#include "hamflow/methods/splitting.hpp"
@includes@
#define HAMFLOW_FOR_EACH_TABLEAU(X)@tableau_macro@
namespace hamflow {
inline const std::vector<const CompositionTable*>& composition_tables() {
  static const std::vector<const CompositionTable*> all{@composition_list@};
  return all;
}
inline const std::vector<const SplittingTable*>& splitting_tables() {
  static const std::vector<const SplittingTable*> all{@splitting_list@};
  return all;
}
inline const std::vector<const ForceGradientTable*>& force_gradient_tables() {
  static const std::vector<const ForceGradientTable*> all{@force_gradient_list@};
  return all;
}
}  // namespace hamflow
]] @ONLY)

file(GLOB family_files CONFIGURE_DEPENDS "${PROJECT_SOURCE_DIR}/src/methods/families/*.hpp")
list(SORT family_files)
set(family_includes "")
set(family_types)
foreach(file IN LISTS family_files)
  get_filename_component(name "${file}" NAME_WE)
  hamflow_pascal_case(type ${name})
  string(APPEND family_includes "#include \"methods/families/${name}.hpp\"\n")
  list(APPEND family_types ${type})
endforeach()
list(JOIN family_types ", " family_types)
file(CONFIGURE OUTPUT "${generated}/family_list.hpp" CONTENT [[
#pragma once
@family_includes@
namespace hamflow::families {
template <class... Families>
struct List;
using All = List<@family_types@>;
}  // namespace hamflow::families
]] @ONLY)

file(CONFIGURE OUTPUT "${generated}/catalog_lists.hpp" CONTENT [[
#pragma once
#include "engine/erased.hpp"
#include "problems/typed_entry.hpp"
namespace hamflow {
@declarations@
inline ProblemEntry joined(const TypedEntry& typed, const ErasedEntry& erased) {
  ProblemEntry entry = erased.facts;
  entry.accepts = typed.accepts;
  entry.simulate = typed.simulate;
  entry.has_pairwise_forces = typed.has_pairwise_forces;
  entry.simulate_erased = erased.simulate;
  entry.simulate_member = erased.simulate_member;
  entry.step_map = [accepts = entry.accepts, make = erased.step_map](const Request& request, std::size_t size) {
    return accepts(request.method) ? make(request, size) : nullptr;
  };
  return entry;
}
inline std::vector<ProblemEntry> generated_problems() { return {@problem_calls@}; }
/// In the same order.
inline std::vector<ErasedEntry> generated_erased() { return {@erased_calls@}; }
}  // namespace hamflow
]] @ONLY)
