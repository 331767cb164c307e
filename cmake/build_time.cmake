# SPDX-License-Identifier: Apache-2.0
#
# What makes a build from nothing take less than half the time. Reading the headers of the standard library, of JSON and of
# the command line takes several times as long as compiling what a source file says itself, so the sources of layers
# that compute little are compiled in bundles. In a bundle anonymous namespaces are one: names in them differ within a
# layer. With a compiler cache every file is compiled alone, as changes of single files are what counts then.
if(CMAKE_CXX_COMPILER_LAUNCHER)
  set(default OFF)
else()
  set(default ON)
endif()
option(FEXP_BUNDLES "Compile sources that compute little in bundles" ${default})

# fexp_bundle(<target>)
function(fexp_bundle target)
  if(FEXP_BUNDLES)
    set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_BATCH_SIZE 7)
    if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
      # A guess of the optimiser that g++ 12 gets wrong for a std::vector that grows, as in base/byte_stream.hpp, in some
      # bundles and not in others.
      target_compile_options(${target} PRIVATE -Wno-stringop-overflow)
    endif()
  endif()
endfunction()
