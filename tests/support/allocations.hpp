// Counts the allocations of an executable that links allocations.cpp.
#pragma once

namespace hamflow::test {
long long allocations();
}
