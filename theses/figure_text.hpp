// Labels of figures as plain text.
#pragma once

#include <string>

namespace hamflow::reproduction {

/// gnuplot's enhanced text without its marks: "{/:Italic p}_1" is "p1".
std::string plain_text(const std::string& enhanced);

}  // namespace hamflow::reproduction
