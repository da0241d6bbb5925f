# The address and undefined-behaviour sanitizers: everywhere, or (FILES) in what reads and writes files and typed text,
# and makes machine code. The kernels of the catalogue, and what judges them, only meet numbers and are half of the
# compiler's time. Checks of null and misaligned pointers are left out there: the first end the program anyway, and
# each pointer would have both.
set(sanitizers -fsanitize=address,undefined -fno-sanitize-recover=all)
set(sanitizers_of_files ${sanitizers} -fno-sanitize=null,alignment,vptr -g1)
set(doubts $<$<CXX_COMPILER_ID:GNU>:-Wno-maybe-uninitialized>)  # GCC sees it in <regex> where it has put its checks
if(HAMFLOW_SANITIZE)
  target_link_options(hamflow_flags INTERFACE -fsanitize=address,undefined)
  if(NOT HAMFLOW_SANITIZE STREQUAL "FILES")
    target_compile_options(hamflow_flags INTERFACE ${sanitizers} ${doubts})
  endif()
endif()

# What FILES means.
function(hamflow_attacked target)
  if(HAMFLOW_SANITIZE STREQUAL "FILES")
    target_compile_options(${target} PRIVATE ${sanitizers_of_files} ${doubts})
  endif()
endfunction()
