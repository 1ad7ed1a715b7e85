# EspdiffDependencies.cmake: finds the libraries, and records which parts are left out and why.

set_property(GLOBAL PROPERTY ESPDIFF_SUMMARY "")
function(espdiff_note text)
  set_property(GLOBAL APPEND_STRING PROPERTY ESPDIFF_SUMMARY "\n  ${text}")
endfunction()

# espdiff_resolve(OPTION found "what" "how to get it"): turns AUTO into ON or OFF and fails on ON when not found.
function(espdiff_resolve option found what remedy)
  if(${option} STREQUAL "OFF")
    espdiff_note("${what}: off (${option}=OFF)")
    set(${option}_ENABLED OFF PARENT_SCOPE)
  elseif(found)
    espdiff_note("${what}: on")
    set(${option}_ENABLED ON PARENT_SCOPE)
  elseif(${option} STREQUAL "ON")
    message(FATAL_ERROR "${what} was asked for (${option}=ON) but ${remedy}")
  else()
    espdiff_note("${what}: left out; ${remedy}")
    set(${option}_ENABLED OFF PARENT_SCOPE)
  endif()
endfunction()

function(espdiff_print_summary)
  get_property(ESPDIFF_SUMMARY GLOBAL PROPERTY ESPDIFF_SUMMARY)
  message(STATUS "espdiff ${PROJECT_VERSION}:${ESPDIFF_SUMMARY}")
endfunction()

find_package(Threads REQUIRED)
find_package(OpenMP REQUIRED COMPONENTS CXX)
find_package(Eigen3 REQUIRED NO_MODULE)
find_package(CLI11 REQUIRED)
find_package(nlohmann_json REQUIRED)
find_package(Boost 1.70 REQUIRED CONFIG)  # headers only: distributions of Boost.Math

# CUDA: for the second back end only.
if(NOT ESPDIFF_CUDA STREQUAL "OFF")
  include(CheckLanguage)
  check_language(CUDA)
  if(CMAKE_CUDA_COMPILER)
    if(NOT DEFINED CMAKE_CUDA_ARCHITECTURES)
      set(CMAKE_CUDA_ARCHITECTURES 90 CACHE STRING "GPU architectures; the release preset takes all")
    endif()
    enable_language(CUDA)
    find_package(CUDAToolkit REQUIRED)
    set(CMAKE_CUDA_STANDARD 17)
    set(CMAKE_CUDA_STANDARD_REQUIRED ON)
  endif()
endif()
espdiff_resolve(ESPDIFF_CUDA "${CMAKE_CUDA_COMPILER}" "CUDA back end" "no nvcc was found (set CUDACXX, or install the CUDA toolkit)")

# Thrust for the CPU back end: Debian's, otherwise the CUDA toolkit's.
find_path(ESPDIFF_THRUST_INCLUDE thrust/for_each.h
  PATHS /usr/include PATH_SUFFIXES cccl NO_CMAKE_SYSTEM_PATH)
if(NOT ESPDIFF_THRUST_INCLUDE AND CUDAToolkit_FOUND)
  find_path(ESPDIFF_THRUST_INCLUDE thrust/for_each.h
    HINTS ${CUDAToolkit_INCLUDE_DIRS} PATH_SUFFIXES cccl)
endif()
if(NOT ESPDIFF_THRUST_INCLUDE)
  message(FATAL_ERROR "Thrust was not found; install libthrust-dev (Debian) or the CUDA toolkit")
endif()
espdiff_note("CPU back end: on (Thrust in ${ESPDIFF_THRUST_INCLUDE}, OpenMP ${OpenMP_CXX_VERSION})")

# One header: the PME potential on the CPU back end. gemmi's packages contain it.
if(NOT ESPDIFF_POCKETFFT STREQUAL "OFF")
  find_path(ESPDIFF_POCKETFFT_INCLUDE pocketfft_hdronly.h PATH_SUFFIXES gemmi/third_party)
endif()
espdiff_resolve(ESPDIFF_POCKETFFT "${ESPDIFF_POCKETFFT_INCLUDE}" "PME potential on the CPU" "pocketfft was not found (Debian: gemmi-dev)")

if(NOT ESPDIFF_ZLIB STREQUAL "OFF")
  find_package(ZLIB QUIET)
endif()
espdiff_resolve(ESPDIFF_ZLIB "${ZLIB_FOUND}" "Compressed text files" "zlib was not found (Debian: zlib1g-dev)")

# HDF5 without MPI: VTK's may be another one in the same program, with symbols of another version.
if(NOT ESPDIFF_HDF5 STREQUAL "OFF")
  find_path(ESPDIFF_HDF5_INCLUDE hdf5.h PATH_SUFFIXES hdf5/serial)
  find_library(ESPDIFF_HDF5_LIBRARY NAMES hdf5_serial hdf5 PATH_SUFFIXES hdf5/serial)
endif()
if(ESPDIFF_HDF5_INCLUDE AND ESPDIFF_HDF5_LIBRARY)
  set(hdf5_found TRUE)
endif()
espdiff_resolve(ESPDIFF_HDF5 "${hdf5_found}" "Ensembles" "HDF5 was not found (Debian: libhdf5-dev)")

# three.js is text that every page contains. Newer versions have no script that runs without a server.
if(NOT ESPDIFF_PAGES STREQUAL "OFF")
  set(three_folders /usr/share/javascript/three ${CMAKE_PREFIX_PATH})
  find_file(ESPDIFF_THREE three.min.js PATHS ${three_folders} PATH_SUFFIXES build)
  find_file(ESPDIFF_THREE_CONTROLS TrackballControls.js PATHS ${three_folders} PATH_SUFFIXES examples/js/controls)
endif()
if(ESPDIFF_THREE AND ESPDIFF_THREE_CONTROLS)
  set(three_found TRUE)
endif()
espdiff_resolve(ESPDIFF_PAGES "${three_found}" "Pages for a browser" "three.js was not found (Debian: libjs-three)")

if(NOT ESPDIFF_GEMMI STREQUAL "OFF")
  find_path(ESPDIFF_GEMMI_INCLUDE gemmi/cif.hpp)
  find_path(ESPDIFF_PEGTL_INCLUDE tao/pegtl.hpp PATH_SUFFIXES gemmi/third_party)  # gemmi's CIF reader includes it
  # From 0.6 on, part of gemmi is a library. Its CMake package is of no use here: Debian's asks for its program too.
  find_library(ESPDIFF_GEMMI_LIBRARY gemmi_cpp)
endif()
if(ESPDIFF_GEMMI_INCLUDE AND ESPDIFF_PEGTL_INCLUDE)
  set(gemmi_found TRUE)
endif()
espdiff_resolve(ESPDIFF_GEMMI "${gemmi_found}" "PDB and mmCIF reader" "gemmi was not found (Debian: gemmi-dev tao-pegtl-dev)")

if(NOT ESPDIFF_VTK STREQUAL "OFF")
  find_package(VTK QUIET COMPONENTS CommonCore CommonMath CommonMisc CommonDataModel CommonExecutionModel IOCore IOXML IOXMLParser IOImage FiltersCore RenderingCore RenderingOpenGL2
    RenderingFreeType RenderingUI FiltersSources DomainsChemistryOpenGL2)
endif()
espdiff_resolve(ESPDIFF_VTK "${VTK_FOUND}" "Renderer and viewer" "VTK 9 was not found (Debian: libvtk9-dev)")

# Tcl through stubs, so that the module loads into VMD's own Tcl of any version from 8.5.
if(NOT ESPDIFF_TCL STREQUAL "OFF")
  find_path(ESPDIFF_TCL_INCLUDE tcl.h PATH_SUFFIXES tcl8.6 tcl8.5 tcl)
  find_library(ESPDIFF_TCL_STUB NAMES tclstub8.6 tclstub8.5)
  find_library(ESPDIFF_TCL_LIBRARY NAMES tcl8.6 tcl8.5)  # for the tests, which link to Tcl
endif()
if(ESPDIFF_TCL_INCLUDE AND ESPDIFF_TCL_STUB AND ESPDIFF_TCL_LIBRARY)
  set(tcl_found TRUE)
endif()
espdiff_resolve(ESPDIFF_TCL "${tcl_found}" "Tcl module for VMD" "Tcl 8.6 was not found (Debian: tcl8.6-dev)")
