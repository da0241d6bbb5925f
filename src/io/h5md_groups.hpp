// The groups and links of an H5MD file, while it is made.
#pragma once

#include <hdf5.h>

#include "run_header.hpp"

namespace hamflow {

/// The groups, and what stands in them once: before any column of samples.
void write_h5md_groups(hid_t file, const RunDescription& run);
/// What is there twice under two names: behind all columns of samples.
void link_h5md_elements(hid_t file, const RunDescription& run);

}  // namespace hamflow
