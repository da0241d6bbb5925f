# Debian packages and the tarball of the command: ./dev package (tools/package/package.py). Each Debian package is a component of
# the installation. The files of packaging/debian that every package needs are made by package.py in ${package_files}.
set(package_files "${PROJECT_BINARY_DIR}/package_files")
set(packages_command hamflow)
set(packages_development libhamflow-dev)
set(packages_python python3-hamflow)
set(packages_documents hamflow-doc)
set(packages_laboratory hamflow-lab)
foreach(component command development python documents laboratory)
  install(DIRECTORY "${package_files}/${packages_${component}}/" DESTINATION share COMPONENT ${component} EXCLUDE_FROM_ALL OPTIONAL)
endforeach()

install(DIRECTORY examples/ DESTINATION share/doc/hamflow/examples COMPONENT command EXCLUDE_FROM_ALL
        FILES_MATCHING PATTERN "*.toml" PATTERN python EXCLUDE)
install(DIRECTORY examples/ DESTINATION share/doc/libhamflow-dev/examples COMPONENT development EXCLUDE_FROM_ALL
        FILES_MATCHING PATTERN "*.cpp" PATTERN formulas EXCLUDE PATTERN python EXCLUDE)
install(DIRECTORY examples/python/ DESTINATION share/doc/python3-hamflow/examples COMPONENT python EXCLUDE_FROM_ALL
        FILES_MATCHING PATTERN "*.py" PATTERN "*.ipynb" PATTERN __pycache__ EXCLUDE)
install(DIRECTORY docs/ DESTINATION share/doc/hamflow-doc/text COMPONENT documents EXCLUDE_FROM_ALL)
install(DIRECTORY "${PROJECT_SOURCE_DIR}/build/site/html" DESTINATION share/doc/hamflow-doc COMPONENT documents EXCLUDE_FROM_ALL OPTIONAL
        PATTERN .buildinfo EXCLUDE PATTERN .doctrees EXCLUDE)
install(FILES "${PROJECT_SOURCE_DIR}/build/web/laboratory.html" DESTINATION share/hamflow COMPONENT laboratory OPTIONAL)
# CMake strips only programs of its own targets. A separate build makes hamflow-reproduce, which is stripped here.
install(CODE [[
  if(CMAKE_INSTALL_DO_STRIP AND EXISTS "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/bin/hamflow-reproduce")
    execute_process(COMMAND strip "$ENV{DESTDIR}${CMAKE_INSTALL_PREFIX}/bin/hamflow-reproduce" COMMAND_ERROR_IS_FATAL ANY)
  endif()
]] COMPONENT command EXCLUDE_FROM_ALL)

# The command of the tarball: the objects of the command, with every library but the C library inside (docs/design/packages.md).
# Debian has fmt and toml++ as shared libraries only, so they are compiled from their headers. Of the others the archives are taken:
# those that are linked by name from a folder with archives alone, those that HDF5 names by their paths whole and first. Then nothing
# needs the shared libraries any more, and --as-needed leaves them out.
set(static "${PROJECT_BINARY_DIR}/static")
find_library(QUADMATH_ARCHIVE libquadmath.a PATHS ${CMAKE_CXX_IMPLICIT_LINK_DIRECTORIES})
foreach(name qd mpfr gmp sz aec z)
  string(TOUPPER ${name} upper)
  find_library(${upper}_ARCHIVE lib${name}.a)
  mark_as_advanced(${upper}_ARCHIVE)
endforeach()
if(HDF5_ARCHIVE AND HAMFLOW_AS_NEEDED AND QUADMATH_ARCHIVE AND QD_ARCHIVE AND MPFR_ARCHIVE AND GMP_ARCHIVE AND SZ_ARCHIVE AND AEC_ARCHIVE AND Z_ARCHIVE)
  file(COPY "${QUADMATH_ARCHIVE}" "${MPFR_ARCHIVE}" "${GMP_ARCHIVE}" DESTINATION "${static}/lib")
  # Of QD a copy whose dd_real::error gives way to that of apps/hamflow/qd_messages.cpp.
  add_custom_command(OUTPUT "${static}/lib/libqd.a" DEPENDS "${QD_ARCHIVE}"
    COMMAND "${CMAKE_OBJCOPY}" --weaken-symbol=_ZN7dd_real5errorEPKc "${QD_ARCHIVE}" "${static}/lib/libqd.a")
  add_executable(hamflow_static_command EXCLUDE_FROM_ALL $<TARGET_OBJECTS:hamflow_command> packaging/tarball/fmt.cpp
                                                         packaging/tarball/toml.cpp "${static}/lib/libqd.a")
  set_target_properties(hamflow_static_command PROPERTIES OUTPUT_NAME hamflow RUNTIME_OUTPUT_DIRECTORY "${static}")
  target_link_options(hamflow_static_command PRIVATE -static-libstdc++ -static-libgcc -s "-L${static}/lib"
                      LINKER:--whole-archive ${SZ_ARCHIVE} ${AEC_ARCHIVE} ${Z_ARCHIVE} LINKER:--no-whole-archive)
  get_target_property(libraries hamflow_command LINK_LIBRARIES)
  target_link_libraries(hamflow_static_command PRIVATE ${libraries})
endif()

set(CPACK_GENERATOR DEB)
set(CPACK_PACKAGE_NAME hamflow)
set(CPACK_PACKAGE_VERSION ${PROJECT_VERSION})
set(CPACK_PACKAGE_CONTACT "The hamflow authors <authors@hamflow.invalid>")  # the project has no address
set(CPACK_PACKAGING_INSTALL_PREFIX /usr)
set(CPACK_INSTALL_DEFAULT_DIRECTORY_PERMISSIONS OWNER_READ OWNER_WRITE OWNER_EXECUTE GROUP_READ GROUP_EXECUTE WORLD_READ WORLD_EXECUTE)
set(CPACK_STRIP_FILES ON)
set(CPACK_COMPONENTS_GROUPING IGNORE)
set(CPACK_DEB_COMPONENT_INSTALL ON)
set(CPACK_DEBIAN_FILE_NAME DEB-DEFAULT)
set(CPACK_DEBIAN_PACKAGE_RELEASE 1)
set(CPACK_DEBIAN_PACKAGE_CONTROL_STRICT_PERMISSION ON)
set(CPACK_DEBIAN_COMPRESSION_TYPE gzip)  # xz takes minutes to save a quarter
set(CPACK_DEBIAN_PACKAGE_SOURCE hamflow)
foreach(component command development python documents laboratory)
  string(TOUPPER ${component} upper)
  set(CPACK_DEBIAN_${upper}_PACKAGE_NAME ${packages_${component}})
  set(CPACK_DEBIAN_${upper}_PACKAGE_SECTION science)
endforeach()
set(this "(= ${PROJECT_VERSION}-${CPACK_DEBIAN_PACKAGE_RELEASE})")
set(drawing "gnuplot-nox | gnuplot-qt | gnuplot-x11, fonts-dejavu-core")

set(CPACK_COMPONENT_COMMAND_DESCRIPTION "structure-preserving integration of Hamiltonian systems
hamflow integrates Hamilton's equations over 10^6 to 10^10 steps with
symplectic, energy-conserving and reversible methods. Every run has a
certificate that judges its energy error, its conserved quantities and its
reversal.

This package has the command, its manual page and scenarios to start from.")
set(CPACK_DEBIAN_COMMAND_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_COMMAND_PACKAGE_DEPENDS ${drawing})
set(CPACK_DEBIAN_COMMAND_PACKAGE_SUGGESTS "hamflow-doc, python3-hamflow")

set(CPACK_COMPONENT_DEVELOPMENT_DESCRIPTION "C++ library for Hamiltonian systems - development files
Headers, static libraries and the CMake package of hamflow, which
integrates Hamilton's equations with symplectic, energy-conserving and
reversible methods.")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SECTION libdevel)
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_DEPENDS
    "libasmjit-dev, libeigen3-dev, libfmt-dev, libgmp-dev, libhdf5-dev, libmpfr-dev, libqd-dev, libtomlplusplus-dev")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_RECOMMENDS "cmake (>= 3.25), g++ (>= 4:12)")
set(CPACK_DEBIAN_DEVELOPMENT_PACKAGE_SUGGESTS "${drawing}, hamflow-doc")

set(CPACK_COMPONENT_PYTHON_DESCRIPTION "structure-preserving integration of Hamiltonian systems - Python module
The module hamflow integrates Hamilton's equations with symplectic,
energy-conserving and reversible methods. Hamiltonians are names, formulas
or Python functions; steps run as machine code; arrays are views of the
memory of the library.")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SECTION python)
set(CPACK_DEBIAN_PYTHON_PACKAGE_SHLIBDEPS ON)
set(CPACK_DEBIAN_PYTHON_PACKAGE_DEPENDS "python3 (>= 3.11), python3 (<< 3.12), python3-numpy, ${drawing}")
set(CPACK_DEBIAN_PYTHON_PACKAGE_RECOMMENDS python3-matplotlib)
# Byte code is made at installation and goes with the package.
set(CPACK_DEBIAN_PYTHON_PACKAGE_CONTROL_EXTRA "${PROJECT_SOURCE_DIR}/packaging/debian/python/postinst;${PROJECT_SOURCE_DIR}/packaging/debian/python/prerm")
set(CPACK_DEBIAN_PYTHON_PACKAGE_SUGGESTS "python3-h5py, python3-pandas, python3-distributed, hamflow-doc")

set(CPACK_COMPONENT_DOCUMENTS_DESCRIPTION "structure-preserving integration of Hamiltonian systems - documentation
Tutorials, how-to pages, the reference and the design pages of hamflow,
which integrates Hamilton's equations with symplectic, energy-conserving
and reversible methods.")
set(CPACK_DEBIAN_DOCUMENTS_PACKAGE_SECTION doc)
set(CPACK_DEBIAN_DOCUMENTS_PACKAGE_ARCHITECTURE all)

set(CPACK_COMPONENT_LABORATORY_DESCRIPTION "structure-preserving integration of Hamiltonian systems - web page
The laboratory of hamflow is one HTML file: it integrates in the browser
and draws motions, sections and energies while they are computed.")
set(CPACK_DEBIAN_LABORATORY_PACKAGE_ARCHITECTURE all)
include(CPack)
