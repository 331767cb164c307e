// SPDX-License-Identifier: Apache-2.0
//
// Packs of different widths do not mix: lanes would silently be lost.
#include "base/pack.hpp"

double sum(fexp::Pack<2> a, fexp::Pack<2> b) { return (a + b).lane(0); }
