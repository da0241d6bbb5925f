// The QD library prints a line on stderr for each angle that is too large to be reduced, and returns NaN. Trial
// sub-steps often meet such angles and are repeated with a shorter step; a run that ends at one reports a failure. So
// the command replaces the library's function by one that prints nothing.
#include <qd/dd_real.h>

void dd_real::error(const char* /*message*/) {}
