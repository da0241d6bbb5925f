// Version of the format of all files that hamflow writes: run.h5, reverse.h5, sweep.h5, checkpoint.bin, members.bin and
// summary.json. The major number changes if a reader of the version before would misread a file. Every later version
// reads all files since 1.0. The minor number changes if something is added.
#pragma once

#include <cstdint>
#include <string>

#include "hamflow/core/error.hpp"

namespace hamflow {

inline constexpr const char* file_format = "1.0";
/// The same in the second word of binary files: major << 16 | minor. Files from before 1.0 have a small number there.
inline constexpr std::uint64_t file_format_word = 1 << 16;

/// Another version of hamflow wrote a file, which is intact but cannot be read.
class OtherFormat : public FileError {
 public:
  using FileError::FileError;
};

/// Returns what is wrong with a format, "has format 2.0; ...", or an empty text if this version can read it.
std::string refused_format(const std::string& found);
std::string refused_format(std::uint64_t word);

}  // namespace hamflow
