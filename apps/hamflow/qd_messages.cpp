// The library of double-double writes a line to stderr for each angle that is too large to be reduced, and returns NaN.
// Trial sub-steps meet such angles by the dozen and are repeated with a shorter one, and a run that comes to one fails
// and says so itself: this takes the place of the library's own function, in the command alone.
#include <qd/dd_real.h>

void dd_real::error(const char* /*message*/) {}
