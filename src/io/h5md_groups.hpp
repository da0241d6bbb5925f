// Makes the groups and links of an H5MD file.
#pragma once

#include <hdf5.h>

#include "run_header.hpp"

namespace hamflow {

/// Makes the groups and their datasets of one row. Call it before any column of samples is made.
void write_h5md_groups(hid_t file, const RunDescription& run);
/// Links data that H5MD wants under a second name. Call it after all columns of samples were made.
void link_h5md_elements(hid_t file, const RunDescription& run);

}  // namespace hamflow
