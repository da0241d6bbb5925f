// All keys that a sweep varies, and the values of each member.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <vector>

#include "vary.hpp"

namespace hamflow {

class Formula;

inline constexpr std::size_t most_members = 10'000'000;  // in one sweep

class Varied {
 public:
  Varied() = default;
  /// @param in_step true: the n-th member has the n-th value of each key; false: there is a member for every
  /// combination, and the last key changes fastest. Values of formulas follow from the other keys.
  /// @throws Error if there are too many members, if lists in step have different lengths, or if a formula names
  /// something
  /// that is not another varied key with numbers
  Varied(std::vector<Vary> keys, bool in_step);

  std::size_t members() const { return members_; }
  const std::vector<Vary>& keys() const { return keys_; }
  std::size_t size() const { return keys_.size(); }
  bool in_step() const { return in_step_; }
  /// The keys whose values do not follow from others; a figure is drawn over them. In step it is only the first key.
  std::vector<std::size_t> free_keys() const;
  std::vector<std::string> paths() const;

  /// Index of the value of a key that a member has; 0 for formulas.
  std::size_t place(std::size_t member, std::size_t key) const;
  /// The value as --set accepts it. For a formula, the values of the other keys replace their paths, so that every
  /// arithmetic evaluates it in its own digits.
  std::string text(std::size_t member, std::size_t key) const;
  /// The same as a number; NaN if a formula has no value.
  double number(std::size_t member, std::size_t key) const;
  /// Explains why a formula for a component of the start has no value for this member, such as sqrt(0.25 - q^2) with q
  /// > 1/2. Otherwise empty: for other keys a formula without a value is an error.
  std::string without_start(std::size_t member, std::size_t key) const;
  /// "member 3: problem.k=0.5, run.dt=0.1"; formulas appear as they were typed.
  std::string described(std::size_t member) const;
  /// Rewrites a complaint about a formula that contains the member's values: it quotes the formula as it was typed, and
  /// lists the values.
  std::string as_typed(std::string complaint, std::size_t member) const;

 private:
  std::size_t key_of(const std::string& path) const;
  void check_formula(std::size_t key, std::vector<std::size_t> behind);

  std::vector<Vary> keys_;
  // formulas with let or sum, which number expressions cannot have
  std::map<std::size_t, std::shared_ptr<const Formula>> formulas_;
  bool in_step_ = false;
  std::size_t members_ = 0;
};

}  // namespace hamflow
