// SPDX-License-Identifier: Apache-2.0
//
// Ids of different kinds do not mix.
#include "base/index.hpp"

bool same(fexp::NodeId a, fexp::ElementId b) { return a == b; }
