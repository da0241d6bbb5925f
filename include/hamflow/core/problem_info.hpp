// One declaration per problem; the command's help and checks, the documentation and the output files are made from it.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <variant>
#include <vector>

#include "hamflow/core/number.hpp"
#include "hamflow/core/vector.hpp"
#include "hamflow/detail/core/option_info.hpp"

namespace hamflow {

/// A parameter of a problem is an option like any other; its default is a formula of numbers or "[...]".
using ParameterInfo = OptionInfo;

/// How many numbers an invariant has: one, one for each dimension of space, or as many as space has rotations.
enum class Components { one, space, rotations };

/// What an invariant is a sum of. With it a momentum map is judged: its size times what rounding makes of each term
/// bounds the error that rounding alone explains (verify/certificate.hpp).
enum class Terms {
  other,          // the excursion is reported but not judged
  momentum,       // one momentum coordinate, such as p_phi
  momenta,        // momenta, such as the total momentum
  moments,        // products of a position and a momentum, such as x p_y - y p_x
  centre_of_mass  // sum m x/M - P t/M; the problem has total_mass()
};

struct InvariantInfo {
  std::string name;
  std::string meaning;
  Components components = Components::one;
  Terms terms = Terms::other;
};

/// A geometric start: the keys of `orbit` that it takes, all required. `direction` is always allowed beside them. With
/// an empty kind the keys alone select it.
struct StartInfo {
  std::string kind;
  std::vector<std::string> keys;
  std::string meaning;
  std::vector<std::string> derives{};  // parameters of the problem that follow from the start and must not be given
  Texts example{};                     // a value for each key
  Texts example_parameters{};          // that the example needs; empty: those of the problem's example
};

/// The frames in which a start can be: as it is given, and that of the centre of mass.
struct StartFrames {
  static constexpr const char* given = "given";
  static constexpr const char* barycentric = "barycentric";
};

/// Where `hamflow verify` measures a method: states in which the motion is bounded, regular and, where the problem is,
/// nonlinear, far from turning points and apsides, where defects are largest. Missing parameters take their defaults.
struct RegionInfo {
  Texts parameters{};
  std::vector<double> centre{};  // q, then p; empty: the default start, each coordinate moved a little
  double spread = 0.1;           // random states: each coordinate uniform within centre +- spread
  double step = 0.1;  // for structure and energy, a sixtieth of a period; no power of two, whose products do not round
  double time = 2.5;  // over which the order is measured: neither a period nor an apsis
};

/// The scenario that `hamflow new` prints. What is not given is that of the region: parameters, q and p, dt.
struct ExampleInfo {
  Texts parameters{};
  std::vector<double> q{};
  std::vector<double> p{};
  double dt = 0;
  std::int64_t steps = 1000;
  std::string start{};  // the kind of the geometric start that is active; empty: the state
  Texts keys{};         // of ProblemInfo::keys those that are set, with their values; empty: the example of the key
};

/// A wall that belongs to the problem.
struct FixedWall {
  std::size_t coordinate = 0;
  std::string min;  // number expressions
  std::string max;
};

struct ProblemInfo {
  std::string name;                                            // as in a scenario
  std::vector<std::pair<std::string, std::string>> variant{};  // keys that select among entries of one name
  std::vector<std::string> default_choices{};  // keys of `variant`; without them a scenario means this entry
  std::vector<std::string> example_choices{};  // keys that a scenario has to give; without them `new` takes this entry
  /// The key of `variant` whose value names the chart, that is, the coordinates. Entries that differ in it alone are
  /// one motion; all but the one in the reference chart have to_reference and from_reference
  /// (detail/core/optional_functions.hpp). Empty: there are no other coordinates.
  std::string chart_key{};
  /// The key of `variant` that takes "formula", too: the choice is then typed (run/catalog.hpp, typed_examples).
  std::string typed_choice{};
  std::string formula{};
  std::string reference{};
  std::vector<std::string> coordinates{};
  std::vector<std::string> angles{};  // coordinates with period 2 pi; they are not wrapped
  std::vector<ParameterInfo> parameters{};
  /// The keys of [problem], in the order in which they are shown, where others than the parameters stand there.
  std::span<const OptionInfo> keys{};
  std::string file_key{};  // the one that names a file with the start; empty: there is none
  std::vector<InvariantInfo> invariants{};
  std::vector<StartInfo> starts{};
  /// Empty: the starts are chosen by the kind of `orbit`. Else this key of the problem counts them, 1, 2, ..., and
  /// their keys stand beside it.
  std::string start_key{};
  std::vector<std::string> default_q{};  // number expressions; empty: a scenario has to give a start
  std::vector<std::string> default_p{};
  /// The key that moves the centre of mass of a start to the origin and to rest (its words are those of
  /// StartFrames), with its default; a start by `initial` stays as it is given unless the key says otherwise.
  /// Without a name there is none. A problem that has it has to_barycentre() (detail/core/optional_functions.hpp).
  OptionInfo frame{};
  /// The name of the key that gives the start its velocities where `initial` is not given; empty: there is none.
  OptionInfo velocities{};
  std::vector<std::size_t> velocity_places{};  // the coordinates that it gives, others rest; empty: all, in order
  std::vector<FixedWall> walls{};              // a scenario chooses their rule alone
  RegionInfo region_at_walls{};                // a second region, of motion that meets them; without centre: none
  std::vector<std::pair<std::string, std::string>> observables{};  // names and expressions, averaged in every run
  bool two_bodies =
      false;  // a planar relative motion: `bodies` may give two bodies in space, from which `mass` follows
  RegionInfo region{};
  ExampleInfo example{};
};

/// The keys of [problem] that give the problem, beside those of its choices and its start.
inline std::span<const OptionInfo> keys_of(const ProblemInfo& info) {
  return info.keys.empty() ? std::span<const OptionInfo>(info.parameters) : info.keys;
}

/// The value of a selecting key in this entry; empty if it has no such key.
inline std::string choice_of(const ProblemInfo& info, const std::string& key) {
  for (const auto& [name, value] : info.variant) {
    if (name == key) return value;
  }
  return {};
}

/// The parts of "[1, 2/3, atan2(1, 2)]", or the text itself when it is no list.
inline std::vector<std::string> list_parts(const std::string& text) {
  if (text.empty() || text.front() != '[') return {text};
  std::vector<std::string> parts;
  int depth = 0;
  std::string part;
  for (std::size_t i = 1; i + 1 < text.size(); ++i) {
    const char c = text[i];
    if (c == '(') ++depth;
    if (c == ')') --depth;
    if (c == ',' && depth == 0) {
      parts.push_back(part);
      part.clear();
    } else if (c != ' ' || !part.empty()) {
      part += c;
    }
  }
  if (!part.empty()) parts.push_back(part);
  return parts;
}

/// Values by name, read in R from the given text, so that every arithmetic reads its own digits.
template <class R>
class Parameters {
 public:
  Parameters() = default;
  /// An empty text is a parameter that was not given.
  explicit Parameters(const std::map<std::string, std::string>& texts) {
    for (const auto& [name, text] : texts) {
      if (text.empty()) continue;
      for (const std::string& part : list_parts(text)) values_[name].push_back(evaluate_number<R>(part));
    }
  }
  bool has(const std::string& name) const { return values_.contains(name); }
  /// A single number.
  R operator[](const std::string& name) const { return values_.at(name).at(0); }
  const std::vector<R>& list(const std::string& name) const { return values_.at(name); }
  void set(const std::string& name, const R& value) { values_[name] = {value}; }
  /// The same values in another number type.
  template <class To>
  Parameters<To> as() const {
    Parameters<To> out;
    for (const auto& [name, list] : values_) {
      std::vector<To> values;
      for (const R& x : list) values.push_back(static_cast<To>(x));
      out.set_list(name, values);
    }
    return out;
  }
  void set_list(const std::string& name, const std::vector<R>& values) { values_[name] = values; }

 private:
  std::map<std::string, std::vector<R>> values_;
};

/// A canonical state.
template <class R, std::size_t N>
struct Start {
  Vector<R, N> q{};
  Vector<R, N> p{};
};

/// What is known of an orbit before it is integrated: names and values.
using OrbitFacts = std::vector<std::pair<std::string, std::variant<double, std::string, bool>>>;

/// A condition on a geometric start: left < right or left <= right has to hold. The message says by how much it fails.
struct Condition {
  std::string key;        // the scenario key at fault
  std::string statement;  // e.g. "r_per <= r_aph"
  double left = 0;
  double right = 0;
  bool strict = false;
  bool holds() const { return strict ? left < right : left <= right; }
};

/// The conditions of one start, in the order in which they were stated.
class Conditions {
 public:
  template <class R>
  void require(const char* key, const char* statement, const R& left, const R& right, bool strict) {
    all_.push_back({key, statement, static_cast<double>(left), static_cast<double>(right), strict});
  }
  const std::vector<Condition>& all() const { return all_; }

 private:
  std::vector<Condition> all_;
};

}  // namespace hamflow
