# SPDX-License-Identifier: Apache-2.0
#
# The same input gives the same bits for any number of threads, compiler, optimisation level and instruction set. That
# holds only while every operation is rounded as written, so these flags apply to every target and nothing may override
# them: no -ffast-math, -Ofast or -funsafe-math-optimizations, and no -march=native.
#
# -ffp-contract=off     a * b + c keeps its two roundings. Compilers that may fuse it into one fma do so depending on
#                       optimisation level and instruction set.
# -fno-math-errno       sqrt need not set errno, so it becomes one vector instruction. No value changes.
# -fno-trapping-math    no floating-point exception is ever unmasked, so both sides of a selection may be computed.
#                       No value changes.
add_compile_options(-ffp-contract=off -fno-math-errno -fno-trapping-math)

foreach(flags IN ITEMS "${CMAKE_CXX_FLAGS}" "${CMAKE_CXX_FLAGS_RELEASE}" "${CMAKE_CXX_FLAGS_DEBUG}")
  if(flags MATCHES "-ffast-math|-Ofast|-funsafe-math|-fassociative-math|-ffp-contract=(fast|on)|-march=native")
    message(FATAL_ERROR "The flags '${flags}' would change results from machine to machine. Remove them: the kernels "
                        "choose the widest instruction set of the machine while running.")
  endif()
endforeach()

# Vector kernels for wider instruction sets are compiled on x86-64 only and chosen while running.
if(CMAKE_SYSTEM_PROCESSOR MATCHES "^(x86_64|AMD64|amd64)$")
  set(FEXP_X86 1)
else()
  set(FEXP_X86 0)
endif()
add_compile_definitions(FEXP_X86=${FEXP_X86})
set(FEXP_AVX2_FLAGS -mavx2)
set(FEXP_AVX512_FLAGS -mavx512f -mavx512dq -mavx512vl -mprefer-vector-width=512)
if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU" AND CMAKE_CXX_COMPILER_VERSION VERSION_LESS 13)
  # The square root in g++ 12's own avx512fintrin.h reads a value that is undefined on purpose.
  list(APPEND FEXP_AVX512_FLAGS -Wno-uninitialized)
endif()
