# SPDX-License-Identifier: Apache-2.0
#
# Warnings are errors in every preset. Packagers with a newer compiler can configure with
# cmake --compile-no-warning-as-error.
set(CMAKE_COMPILE_WARNING_AS_ERROR ON)

add_compile_options(
  $<$<COMPILE_LANGUAGE:CXX>:-Wall>
  $<$<COMPILE_LANGUAGE:CXX>:-Wextra>
  $<$<COMPILE_LANGUAGE:CXX>:-Wpedantic>
  $<$<COMPILE_LANGUAGE:CXX>:-Wconversion>
  $<$<COMPILE_LANGUAGE:CXX>:-Wsign-conversion>
  $<$<COMPILE_LANGUAGE:CXX>:-Wshadow>
  $<$<COMPILE_LANGUAGE:CXX>:-Wnon-virtual-dtor>
  $<$<COMPILE_LANGUAGE:CXX>:-Woverloaded-virtual>)

# Functions that take or return packs are inlined inside one translation unit, so how such values would be passed
# between units of different instruction sets is of no concern.
add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-Wno-psabi>)

if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
  # Guesses of the optimiser, which g++ 12 gets wrong for std::string (its bugs 105562 and 105329). clang's analyser and
  # the sanitizers look for the same faults.
  add_compile_options($<$<COMPILE_LANGUAGE:CXX>:-Wno-maybe-uninitialized> $<$<COMPILE_LANGUAGE:CXX>:-Wno-restrict>)
endif()
