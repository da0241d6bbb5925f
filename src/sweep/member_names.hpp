// What the numbers in the rows of a sweep's members are called. Members can differ in their walls, containers,
// invariants and events: the table has every name that one of them has, and a number never stands under another's name.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include "hamflow/run/state_names.hpp"
#include "hamflow/scenario/scenario.hpp"

namespace hamflow {

/// The names of one member, each list in the order of the numbers in its row (MemberRow).
struct MemberNames {
  /// @param columns further ones, those of MemberRow::observables
  MemberNames(const Scenario& scenario, std::vector<std::string> columns);

  std::vector<InvariantInfo> invariants;
  std::vector<std::size_t> sizes;  // how many numbers each invariant is
  std::vector<std::string> walls;  // one for each wall; several may have the same
  std::vector<std::string> events;
  bool stops = false;  // one of the events ends the run
  std::vector<std::string> observables;
  StateNames state;

  /// Two are the same when these are.
  std::string key() const;
};

/// A name that some members have, and its places in the lists of each kind of members: none where a kind does not have
/// it, several where walls are counted together.
struct UnitedName {
  std::string name;
  std::vector<std::vector<std::size_t>> places;
};

/// The names of all members: of each kind of members once.
class SweepNames {
 public:
  explicit SweepNames(std::size_t members = 0) : kind_of_(members) {}
  /// In any order, each member once.
  /// @param key of names
  void add(std::size_t member, const MemberNames& names, const std::string& key);
  /// Once all are there. What cannot be columns of one table is returned: an invariant with two numbers of components,
  /// and one member of each. Else the name is empty.
  struct Clash {
    std::string name;
    std::size_t sizes[2] = {};
    std::size_t members[2] = {};
  };
  Clash unite();

  const MemberNames& of(std::size_t member) const { return kinds_[kind_of_[member]].names; }
  /// Of all members, in the order in which these have them.
  const std::vector<UnitedName>& invariants() const { return invariants_; }
  const std::vector<UnitedName>& walls() const { return walls_; }
  const std::vector<UnitedName>& events() const { return events_; }
  const std::vector<UnitedName>& observables() const { return observables_; }
  /// How many numbers an invariant of all is.
  std::size_t size(const UnitedName& invariant) const;
  /// Whether an event can end the run of a member.
  bool stop() const;
  /// Coordinates and momenta; q1, p1 and so on where members call them otherwise.
  const StateNames& state() const { return state_; }
  bool have_same_state() const { return same_state_; }
  const std::vector<std::size_t>& places(const UnitedName& name, std::size_t member) const {
    return name.places[kind_of_[member]];
  }

 private:
  struct Kind {
    MemberNames names;
    std::size_t first;  // of its members
  };
  template <class NamesOf>
  std::vector<UnitedName> united(const NamesOf& names_of) const;
  Clash clash() const;

  std::vector<Kind> kinds_;
  std::vector<std::uint32_t> kind_of_;  // each member
  std::map<std::string, std::uint32_t> known_;
  std::vector<UnitedName> invariants_, walls_, events_, observables_;
  StateNames state_;
  bool same_state_ = true;
};

}  // namespace hamflow
