#include "member_names.hpp"

#include <algorithm>
#include <numeric>

#include "bounce_names.hpp"

namespace hamflow {

namespace {

std::vector<std::string> names_among(const std::vector<InvariantInfo>& invariants) {
  std::vector<std::string> all;
  for (const InvariantInfo& invariant : invariants) all.push_back(invariant.name);
  return all;
}

}  // namespace

MemberNames::MemberNames(const Scenario& scenario, std::vector<std::string> columns)
    : invariants(scenario.problem->info.invariants),
      sizes(scenario.problem->invariant_sizes(scenario.request.parameters, scenario.start_q.size())),
      walls(bounce_names(scenario)),
      observables(std::move(columns)),
      state(state_names(*scenario.problem, scenario.request.parameters, scenario.start_q.size())) {
  for (const UserEvent& event : scenario.events) {
    events.push_back(event.name);
    stops = stops || event.stops;
  }
}

std::string MemberNames::key() const {
  std::string all;
  const auto add = [&all](const std::vector<std::string>& names) {
    for (const std::string& name : names) all += name + '\n';
    all += '\n';
  };
  for (std::size_t i = 0; i < invariants.size(); ++i) {
    all += invariants[i].name + ' ' + std::to_string(sizes[i]) + ' ' +
           std::to_string(static_cast<int>(invariants[i].components)) + '\n';
  }
  add(walls);
  add(events);
  add(observables);
  add(state.q);
  add(state.p);
  return all + (stops ? "stops" : "");
}

void SweepNames::add(std::size_t member, const MemberNames& names, const std::string& key) {
  const auto [at, is_new] = known_.try_emplace(key, static_cast<std::uint32_t>(kinds_.size()));
  if (is_new) kinds_.push_back({names, member});
  kinds_[at->second].first = std::min(kinds_[at->second].first, member);
  kind_of_[member] = at->second;
}

template <class NamesOf>
std::vector<MergedName> SweepNames::united(const NamesOf& names_of) const {
  std::vector<MergedName> all;
  std::map<std::string, std::size_t> known;
  for (std::size_t kind = 0; kind < kinds_.size(); ++kind) {
    const std::vector<std::string> names = names_of(kinds_[kind].names);
    for (std::size_t i = 0; i < names.size(); ++i) {
      const auto [at, is_new] = known.try_emplace(names[i], all.size());
      if (is_new) all.push_back({names[i], std::vector<std::vector<std::size_t>>(kinds_.size())});
      all[at->second].places[kind].push_back(i);
    }
  }
  return all;
}

SweepNames::NameConflict SweepNames::merge_all() {
  // Threads meet the kinds in any order, so kinds are sorted by their first members.
  std::vector<std::uint32_t> order(kinds_.size());
  std::iota(order.begin(), order.end(), 0);
  std::sort(order.begin(), order.end(), [this](auto a, auto b) { return kinds_[a].first < kinds_[b].first; });
  std::vector<Kind> kinds;
  std::vector<std::uint32_t> place(order.size());
  for (const std::uint32_t kind : order) {
    place[kind] = static_cast<std::uint32_t>(kinds.size());
    kinds.push_back(std::move(kinds_[kind]));
  }
  kinds_ = std::move(kinds);
  for (std::uint32_t& kind : kind_of_) kind = place[kind];
  known_.clear();
  invariants_ = united([](const MemberNames& names) { return names_among(names.invariants); });
  walls_ = united([](const MemberNames& names) { return names.walls; });
  events_ = united([](const MemberNames& names) { return names.events; });
  observables_ = united([](const MemberNames& names) { return names.observables; });
  state_ = kinds_.front().names.state;
  const auto differs = [this](const Kind& kind) {
    return kind.names.state.q != state_.q || kind.names.state.p != state_.p;
  };
  same_state_ = std::none_of(kinds_.begin(), kinds_.end(), differs);
  if (!same_state_) state_ = numbered_names(state_.q.size());
  return clash();
}

SweepNames::NameConflict SweepNames::clash() const {
  for (const MergedName& invariant : invariants_) {
    const Kind* before = nullptr;
    const auto size_of = [&](const Kind& kind) {
      const auto& places = invariant.places[static_cast<std::size_t>(&kind - kinds_.data())];
      return places.empty() ? 0 : kind.names.sizes[places.front()];
    };
    for (const Kind& kind : kinds_) {
      if (size_of(kind) == 0) continue;
      if (before != nullptr && size_of(kind) != size_of(*before)) {
        return {invariant.name, {size_of(*before), size_of(kind)}, {before->first, kind.first}};
      }
      before = &kind;
    }
  }
  return {};
}

std::size_t SweepNames::size(const MergedName& invariant) const {
  for (std::size_t kind = 0; kind < kinds_.size(); ++kind) {
    if (!invariant.places[kind].empty()) return kinds_[kind].names.sizes[invariant.places[kind].front()];
  }
  return 0;
}

bool SweepNames::stop() const {
  return std::any_of(kinds_.begin(), kinds_.end(), [](const Kind& kind) { return kind.names.stops; });
}

}  // namespace hamflow
