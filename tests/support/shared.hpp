// What most tests include, read once by the compiler for all of them. A test still names what it uses.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <iostream>
#include <map>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "hamflow/arithmetic/double_double.hpp"
#include "hamflow/arithmetic/lattice.hpp"
#include "hamflow/arithmetic/mp.hpp"
#include "hamflow/arithmetic/quad.hpp"
#include "hamflow/methods/cg.hpp"
#include "hamflow/methods/runge_kutta.hpp"
#include "hamflow/methods/splitting.hpp"
#include "hamflow/run/catalog.hpp"
#include "hamflow/run/simulation_of.hpp"
#include "hamflow/verify/measure.hpp"
