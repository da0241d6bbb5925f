// The declaration of a problem. The command's help and checks, the documentation and the output files are made from it.
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

/// The number of components of an invariant: one, one per dimension of space, or one per rotation of space.
enum class Components { one, space, rotations };

/// The kind of terms whose sum is the invariant. From it follows the bound of the error that rounding alone explains:
/// the size of the sum times the rounding of each term (verify/certificate.hpp).
enum class Terms {
  other,          // the deviation is reported but not judged
  momentum,       // one momentum coordinate, such as p_phi
  momenta,        // momenta, such as the total momentum
  moments,        // products of a position and a momentum, such as x p_y - y p_x
  centre_of_mass  // sum m x/M - P t/M; the problem defines total_mass()
};

struct InvariantInfo {
  std::string name;
  std::string meaning;
  Components components = Components::one;
  Terms terms = Terms::other;
};

/// A geometric start: the keys of `orbit` that it takes. All are required; `direction` is always allowed as well. If
/// the kind is empty, the keys select the start.
struct StartInfo {
  std::string kind;
  std::vector<std::string> keys;
  std::string meaning;
  std::vector<std::string> derives{};  // parameters of the problem that the start determines; they must not be given
  Texts example{};                     // value of each key
  Texts example_parameters{};          // parameters for the example; empty: those of the problem's example
};

/// The frames of a start: as it is given, or moved to the centre of mass.
struct StartFrames {
  static constexpr const char* given = "given";
  static constexpr const char* barycentric = "barycentric";
};

/// The states in which `hamflow verify` measures a method. Their motion is bounded, regular and, if the problem is,
/// nonlinear, far from turning points and apsides, where errors are largest. Missing parameters take their defaults.
struct RegionInfo {
  Texts parameters{};
  std::vector<double> centre{};  // q, then p; empty: the default start with each coordinate shifted slightly
  double spread = 0.1;           // random states: each coordinate uniform within centre +- spread
  double step = 0.1;  // for structure and energy: 1/60 of a period; not a power of two, since its products do not round
  double time = 2.5;  // for the order; neither a period nor the time of an apsis
};

/// The scenario that `hamflow new` prints. Missing parameters, q, p and dt are those of the region.
struct ExampleInfo {
  Texts parameters{};
  std::vector<double> q{};
  std::vector<double> p{};
  double dt = 0;
  std::int64_t steps = 10000;
  std::string start{};  // the kind of the geometric start; empty: the start is a state
  Texts keys{};         // values of some of ProblemInfo::keys; an empty value: the example of the key
};

/// A wall that is part of the problem.
struct FixedWall {
  std::size_t coordinate = 0;
  std::string min;  // number expressions
  std::string max;
};

struct ProblemInfo {
  std::string name;                                            // as in a scenario
  std::vector<std::pair<std::string, std::string>> variant{};  // keys that select among entries of one name
  std::vector<std::string> default_choices{};  // keys of `variant`; a scenario without them selects this entry
  std::vector<std::string> example_choices{};  // keys that a scenario must give; `new` without them selects this entry
  /// The key of `variant` whose value names the chart, that is, the coordinates. Entries that differ only in the chart
  /// describe the same motion; all except the reference chart define to_reference and from_reference
  /// (detail/core/optional_functions.hpp). Empty: there is only one chart.
  std::string chart_key{};
  /// The key of `variant` that also accepts "formula": the user then types the formula (run/catalog.hpp,
  /// typed_examples).
  std::string typed_choice{};
  std::string formula{};
  std::string reference{};
  std::vector<std::string> coordinates{};
  std::vector<std::string> angles{};  // coordinates with period 2 pi; they are not wrapped
  std::vector<ParameterInfo> parameters{};
  /// The keys of [problem], in the order in which they are shown, if they are more than the parameters.
  std::span<const OptionInfo> keys{};
  std::string file_key{};  // the key that names a file with the start; empty: there is none
  std::vector<InvariantInfo> invariants{};
  std::vector<StartInfo> starts{};
  /// Empty: the kind of `orbit` selects the start. Otherwise this key of the problem selects it by number, 1, 2, ...,
  /// and the keys of the starts are keys of [problem].
  std::string start_key{};
  std::vector<std::string> default_q{};  // number expressions; empty: a scenario must give a start
  std::vector<std::string> default_p{};
  /// The key that moves the centre of mass of a start to the origin, at rest (its words are those of StartFrames), with
  /// its default. A start by `initial` is not moved unless the key is given. An empty name: there is no such key. A
  /// problem with this key defines to_barycentre() (detail/core/optional_functions.hpp).
  OptionInfo frame{};
  /// The key that gives the velocities of the start if `initial` is not given; an empty name: there is none.
  OptionInfo velocities{};
  std::vector<std::size_t>
      velocity_places{};           // the coordinates with these velocities, others are at rest; empty: all, in order
  std::vector<FixedWall> walls{};  // a scenario chooses only their rule
  RegionInfo region_at_walls{};    // a second region, whose motion hits the walls; without centre: none
  std::vector<std::pair<std::string, std::string>> observables{};  // names and expressions, averaged in every run
  bool two_bodies = false;  // a planar relative motion: `bodies` may give two bodies in space, which determine `mass`
  RegionInfo region{};
  ExampleInfo example{};
};

/// The keys of [problem] that define the problem, apart from those of its variant and its start.
inline std::span<const OptionInfo> keys_of(const ProblemInfo& info) {
  return info.keys.empty() ? std::span<const OptionInfo>(info.parameters) : info.keys;
}

/// The value of a variant key in this entry; empty if there is no such key.
inline std::string choice_of(const ProblemInfo& info, const std::string& key) {
  for (const auto& [name, value] : info.variant) {
    if (name == key) return value;
  }
  return {};
}

/// The parts of "[1, 2/3, atan2(1, 2)]"; the text itself if it is not a list.
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

/// Values by name, read in R from text, so that every arithmetic gets all of its digits.
template <class R>
class Parameters {
 public:
  Parameters() = default;
  /// An empty text means that the parameter was not given.
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
  /// Returns the same values in another number type.
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

/// Facts about an orbit that are known before integration: names and values.
using OrbitFacts = std::vector<std::pair<std::string, std::variant<double, std::string, bool>>>;

/// A condition on a geometric start, left < right or left <= right. The message gives both sides if it fails.
struct Condition {
  std::string key;        // the scenario key at fault
  std::string statement;  // e.g. "r_per <= r_aph"
  double left = 0;
  double right = 0;
  bool strict = false;
  bool holds() const { return strict ? left < right : left <= right; }
};

/// The conditions of a start, in the order in which they were added.
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
