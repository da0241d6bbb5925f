// All keys that a sweep varies, and which values each member has.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "vary.hpp"

namespace hamflow {

class Formula;

inline constexpr std::size_t most_members = 10'000'000;  // of one sweep

class Varied {
 public:
  Varied() = default;
  /// @param in_step the n-th member has the n-th value of each key; else there is a member for every combination, and
  /// the last key changes fastest. Values of formulas follow from the others.
  /// @throws Error when there are too many members, lists of different lengths in step, or a formula that names what is
  /// no other varied key with numbers
  Varied(std::vector<Vary> keys, bool in_step);

  std::size_t members() const { return members_; }
  const std::vector<Vary>& keys() const { return keys_; }
  std::size_t size() const { return keys_.size(); }
  bool in_step() const { return in_step_; }
  /// The keys whose values do not follow from others: over which a figure is drawn. In step the first alone.
  std::vector<std::size_t> free_keys() const;
  std::vector<std::string> paths() const;

  /// Which value of a key a member has; 0 of formulas.
  std::size_t place(std::size_t member, std::size_t key) const;
  /// The value as --set takes it. Of a formula the same with the values of the other keys in the place of their
  /// paths, so that every arithmetic reads its own digits.
  std::string text(std::size_t member, std::size_t key) const;
  /// The same as a number; NaN where a formula has none.
  double number(std::size_t member, std::size_t key) const;
  /// Why a formula of a component of the start gives this member none: sqrt(0.25 - q^2) beyond its reach. Else empty:
  /// of any other key a formula without a value is a wrong request.
  std::string without_start(std::size_t member, std::size_t key) const;
  /// "member 3: problem.k=0.5, run.dt=0.1"; formulas as they were typed.
  std::string described(std::size_t member) const;
  /// A complaint about a formula with the member's values in it, told with the formula as it was typed and the values.
  std::string as_typed(std::string complaint, std::size_t member) const;

 private:
  std::size_t key_of(const std::string& path) const;
  void check_formula(std::size_t key, std::vector<std::size_t> behind);

  std::vector<Vary> keys_;
  std::map<std::size_t, std::shared_ptr<const Formula>> formulas_;  // of those with let or sum, which no number has
  bool in_step_ = false;
  std::size_t members_ = 0;
};

}  // namespace hamflow
