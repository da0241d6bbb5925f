// Estimates the memory of a sweep and finds the available memory, to refuse a sweep that is too large before it starts.
#pragma once

#include <cstdint>
#include <string>

namespace hamflow {

/// Returns the bytes that this process can still allocate: the smallest of the free memory of the machine and of what
/// its control group and its address space limit leave. Returns the largest number if none of them is known.
std::uint64_t available_memory();

/// Returns the bytes of a member's start, row and table columns, for a number of coordinates.
std::uint64_t memory_of_member(std::size_t coordinates);

/// Returns an empty text if this many members fit into the memory, otherwise "found ...; allowed ...".
std::string refused_members(std::size_t members, std::size_t coordinates, std::uint64_t available);

}  // namespace hamflow
