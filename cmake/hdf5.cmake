# HDF5 from its archive where there is one. The shared library of Debian reads files from the web as well, for which it brings
# some thirty libraries along (curl, Kerberos, TLS): to load them was 4 of the 10 ms in which the command starts. Of the archive
# a program has what it uses, and --as-needed leaves those libraries out. The archive is not position-independent: what is loaded
# into another program (the Python module, with the property HAMFLOW_LOADED) takes the shared library, the same as h5py.
find_library(HDF5_ARCHIVE NAMES libhdf5_serial.a libhdf5.a)
mark_as_advanced(HDF5_ARCHIVE)
check_linker_flag(CXX LINKER:--as-needed HAMFLOW_AS_NEEDED)
if(HDF5_ARCHIVE AND HAMFLOW_AS_NEEDED)
  list(TRANSFORM HDF5_C_LIBRARIES REPLACE "^(.*/libhdf5(_serial)?\\.so)$"
       "$<IF:$<BOOL:$<TARGET_PROPERTY:HAMFLOW_LOADED>>,\\1,${HDF5_ARCHIVE}>")
  target_link_options(hamflow_flags INTERFACE LINKER:--as-needed)
endif()
