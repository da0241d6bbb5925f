# A toolchain: Debian's emscripten, WebAssembly for the laboratory (web/). Exceptions are those of WebAssembly.
set(HAMFLOW_EMSCRIPTEN "/usr/share/emscripten" CACHE PATH "the folder of emscripten")
include("${HAMFLOW_EMSCRIPTEN}/cmake/Modules/Platform/Emscripten.cmake")
# Packages of headers are those of the machine on which is built, without the headers of its C library: links to their folders.
set(HAMFLOW_HOST_HEADERS "${CMAKE_BINARY_DIR}/host_headers")
file(MAKE_DIRECTORY "${HAMFLOW_HOST_HEADERS}")
foreach(folder boost fmt nlohmann toml++)
  if(NOT EXISTS "/usr/include/${folder}")
    message(FATAL_ERROR "found no /usr/include/${folder}; ./dev web installs what is missing")
  endif()
  file(CREATE_LINK "/usr/include/${folder}" "${HAMFLOW_HOST_HEADERS}/${folder}" SYMBOLIC)
endforeach()
# The pool of vectors needs no alignment: WebAssembly reads numbers from any address.
set(CMAKE_CXX_FLAGS_INIT "-fwasm-exceptions -fnew-alignment=16 -include ${CMAKE_CURRENT_LIST_DIR}/../src/portable/emscripten/standard_library.hpp")
set(CMAKE_EXE_LINKER_FLAGS_INIT "-fwasm-exceptions")
