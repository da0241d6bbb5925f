// Names of the numbers in the rows of a sweep's members. Members may differ in their walls, containers, invariants and
// events. The table has every name that any member has, and a number is never listed under another name.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hamflow/run/state_names.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// Names of one member. Each list has the order of the numbers in its row (MemberRow).
struct MemberNames {
  /// @param columns names of MemberRow::observables
  MemberNames(const Scenario& scenario, std::vector<std::string> columns);

  std::vector<InvariantInfo> invariants;
  std::vector<std::size_t> sizes;  // number of components of each invariant
  std::vector<std::string> walls;  // one for each wall; several walls may have the same name
  std::vector<std::string> events;
  bool stops = false;  // one of the events can end the run
  std::vector<std::string> observables;
  StateNames state;

  /// Names with equal keys are equal.
  std::string key() const;
};

/// A name that some members have, and its places in the lists of each kind of members. A kind without the name has no
/// place; several walls that are counted together have several.
struct MergedName {
  std::string name;
  std::vector<std::vector<std::size_t>> places;
};

/// The names of all members, stored once for each kind of members.
class SweepNames {
 public:
  explicit SweepNames(std::size_t members = 0) : kind_of_(members) {}
  /// Members may come in any order, but each only once.
  /// @param key key() of names
  void add(std::size_t member, const MemberNames& names, const std::string& key);
  /// Call this after all members were added. Returns an invariant that cannot be in one table because members disagree
  /// on its number of components, with two such members; otherwise the name is empty.
  struct NameConflict {
    std::string name;
    std::size_t sizes[2] = {};
    std::size_t members[2] = {};
  };
  NameConflict merge_all();

  const MemberNames& of(std::size_t member) const { return kinds_[kind_of_[member]].names; }
  /// Names of all members, in the order in which the members have them.
  const std::vector<MergedName>& invariants() const { return invariants_; }
  const std::vector<MergedName>& walls() const { return walls_; }
  const std::vector<MergedName>& events() const { return events_; }
  const std::vector<MergedName>& observables() const { return observables_; }
  /// Returns the number of components of an invariant.
  std::size_t size(const MergedName& invariant) const;
  /// Returns whether an event can end the run of any member.
  bool stop() const;
  /// Names of coordinates and momenta; q1, p1, ... if members disagree.
  const StateNames& state() const { return state_; }
  bool have_same_state() const { return same_state_; }
  const std::vector<std::size_t>& places(const MergedName& name, std::size_t member) const {
    return name.places[kind_of_[member]];
  }

 private:
  struct Kind {
    MemberNames names;
    std::size_t first;  // index of its first member
  };
  template <class NamesOf>
  std::vector<MergedName> united(const NamesOf& names_of) const;
  NameConflict clash() const;

  std::vector<Kind> kinds_;
  std::vector<std::uint32_t> kind_of_;  // kind of each member
  std::map<std::string, std::uint32_t> known_;
  std::vector<MergedName> invariants_, walls_, events_, observables_;
  StateNames state_;
  bool same_state_ = true;
};

}  // namespace hamflow
