# A port for vcpkg. It has not been tried: the address and the checksum of the release have to be filled in.
vcpkg_check_linkage(ONLY_STATIC_LIBRARY)
vcpkg_download_distfile(archive
  URLS "ADDRESS-OF-THE-RELEASE/hamflow-${VERSION}.tar.gz"
  FILENAME "hamflow-${VERSION}.tar.gz"
  SHA512 0)
vcpkg_extract_source_archive(source ARCHIVE "${archive}")
vcpkg_cmake_configure(SOURCE_PATH "${source}"
  OPTIONS -DHAMFLOW_PORTABLE=ON -DHAMFLOW_TESTS=OFF -DHAMFLOW_BENCH=OFF)
vcpkg_cmake_install()
vcpkg_cmake_config_fixup(CONFIG_PATH lib/cmake/hamflow)
vcpkg_copy_tools(TOOL_NAMES hamflow AUTO_CLEAN)
file(REMOVE_RECURSE "${CURRENT_PACKAGES_DIR}/debug/include")
vcpkg_install_copyright(FILE_LIST "${source}/LICENSE")
