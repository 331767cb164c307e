// SPDX-License-Identifier: Apache-2.0
#pragma once

/// For the functions that make up a kernel: called out of line, their operands would go through memory, and compilers
/// find them too large to inline by themselves.
#define FEXP_INLINE [[gnu::always_inline]] inline
