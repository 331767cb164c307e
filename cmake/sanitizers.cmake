# SPDX-License-Identifier: Apache-2.0
if(FEXP_SANITIZE)
  add_compile_options(-fsanitize=${FEXP_SANITIZE} -fno-sanitize-recover=all -fno-omit-frame-pointer)
  add_link_options(-fsanitize=${FEXP_SANITIZE})
endif()
