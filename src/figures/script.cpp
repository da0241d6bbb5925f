#include "script.hpp"

#include "text.hpp"

namespace hamflow::figures {

void Script::label(const std::string& enhanced, double x, double y, const char* how, double points) {
  line("set label {} at screen {:.6f},{:.6f} {} {}", quoted(enhanced), across(x), up(y), how, font(points));
}

void Script::box(double left, double right, double top, double bottom) {
  line("set lmargin at screen {:.6f}", across(left));
  line("set rmargin at screen {:.6f}", across(right));
  line("set tmargin at screen {:.6f}", up(top));
  line("set bmargin at screen {:.6f}", up(bottom));
}

}  // namespace hamflow::figures
