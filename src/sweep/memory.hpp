// Estimates the memory of a sweep and finds the available memory, to refuse a sweep that is too large before it starts.
#pragma once

#include <cstdint>
#include <string>

namespace hamflow {

/// Bytes that this process can still take: the least of what the machine has free, its control group and its limit of
/// address space leave. The largest number there is where none of them is known.
std::uint64_t available_memory();

/// Bytes of a member's start, row, and columns of the table, for that many coordinates.
std::uint64_t memory_of_member(std::size_t coordinates);

/// Empty if so many members fit, else "found ...; allowed ...".
std::string refused_members(std::size_t members, std::size_t coordinates, std::uint64_t available);

}  // namespace hamflow
