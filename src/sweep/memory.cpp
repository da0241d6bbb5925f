#include "memory.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <limits>
#include <optional>

#include "sweep.hpp"

namespace hamflow {

namespace {

std::optional<std::uint64_t> number_in_file(const char* file) {
  std::ifstream in(file);
  std::uint64_t number = 0;
  return in >> number ? std::optional(number) : std::nullopt;  // "max" means that there is no limit
}

std::optional<std::uint64_t> free_on_the_machine() {
  std::ifstream in("/proc/meminfo");
  std::string name;
  std::uint64_t kilobytes = 0;
  std::string unit;
  while (in >> name >> kilobytes) {
    if (name == "MemAvailable:") return kilobytes * 1024;
    std::getline(in, unit);
  }
  return std::nullopt;
}

std::uint64_t left(std::uint64_t limit, std::uint64_t used) { return limit > used ? limit - used : 0; }

}  // namespace

std::uint64_t available_memory() {
  std::uint64_t least = free_on_the_machine().value_or(std::numeric_limits<std::uint64_t>::max());
  const auto most_of_group = number_in_file("/sys/fs/cgroup/memory.max");
  const auto used_of_group = number_in_file("/sys/fs/cgroup/memory.current");
  if (most_of_group && used_of_group) least = std::min(least, left(*most_of_group, *used_of_group));
  rlimit limit{};
  if (getrlimit(RLIMIT_AS, &limit) == 0 && limit.rlim_cur != RLIM_INFINITY) {
    const auto pages = number_in_file("/proc/self/statm").value_or(0);
    least = std::min(least, left(limit.rlim_cur, pages * static_cast<std::uint64_t>(sysconf(_SC_PAGESIZE))));
  }
  return least;
}

std::uint64_t memory_of_member(std::size_t coordinates) {
  // Start and row hold q and p each, and the table holds both twice. About ten vectors have a header each, and about
  // thirty columns are single numbers.
  constexpr std::uint64_t of_vector = 48;
  return sizeof(MemberRow) + sizeof(MemberStart) + 10 * of_vector + 8 * (6 * std::uint64_t{coordinates} + 30);
}

std::string refused_members(std::size_t members, std::size_t coordinates, std::uint64_t available) {
  const std::uint64_t each = memory_of_member(coordinates);
  if (available / each >= members) return {};
  return fmt::format(
      "found {} members of {} coordinates, which take about {:.2g} GB; allowed at most {} with the {:.2g} GB of memory "
      "that are free",
      members, coordinates, 1e-9 * static_cast<double>(each) * static_cast<double>(members), available / each,
      1e-9 * static_cast<double>(available));
}

}  // namespace hamflow
