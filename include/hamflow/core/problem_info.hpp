// One declaration per problem; the command's help and checks, the documentation and the output files are made from it.
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "hamflow/core/number.hpp"
#include "hamflow/core/vector.hpp"

namespace hamflow {

enum class Range { any, positive, not_negative };

struct ParameterInfo {
  std::string name;
  std::string default_value;  // a number expression
  std::string meaning;
  Range range = Range::any;
};

struct InvariantInfo {
  std::string name;
  std::string meaning;
};

/// A geometric start: the keys of `orbit` that it takes, all required. `direction` is always allowed beside them.
struct StartInfo {
  std::string kind;
  std::vector<std::string> keys;
  std::string meaning;
  std::vector<std::string> derives{};  // parameters of the problem that follow from the start and must not be given
};

struct ProblemInfo {
  std::string name;                                            // as in a scenario
  std::vector<std::pair<std::string, std::string>> variant{};  // keys that select among entries of one name
  std::string formula{};
  std::string reference{};
  std::vector<std::string> coordinates{};
  std::vector<ParameterInfo> parameters{};
  std::vector<InvariantInfo> invariants{};
  std::vector<StartInfo> starts{};
  std::vector<std::string> default_q{};  // number expressions; empty: a scenario has to give a start
  std::vector<std::string> default_p{};
};

/// Values by name, kept as the text that was given, so that every arithmetic reads its own digits.
template <class R>
class Parameters {
 public:
  Parameters() = default;
  explicit Parameters(const std::map<std::string, std::string>& texts) {
    for (const auto& [name, text] : texts) values_[name] = evaluate_number<R>(text);
  }
  R operator[](const std::string& name) const { return values_.at(name); }
  void set(const std::string& name, const R& value) { values_[name] = value; }

 private:
  std::map<std::string, R> values_;
};

/// A canonical state.
template <class R, std::size_t N>
struct Start {
  Vector<R, N> q{};
  Vector<R, N> p{};
};

/// A condition on a geometric start: left < right or left <= right has to hold. The message says by how much it fails.
struct Condition {
  std::string key;        // the scenario key to blame
  std::string statement;  // e.g. "r_per <= r_aph"
  double left = 0;
  double right = 0;
  bool strict = false;
  bool holds() const { return strict ? left < right : left <= right; }
};

/// The conditions of one start, in the order in which they were asked.
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
