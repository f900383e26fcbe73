# Installs the build tree, builds docs/examples/robot_app on the installed package alone, and runs it on
# a drive that the installed programs made.
function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE code OUTPUT_VARIABLE out ERROR_VARIABLE out)
  if(NOT code EQUAL 0)
    list(JOIN ARGN " " line)
    message(FATAL_ERROR "${line}\ngave ${code}:\n${out}")
  endif()
  set(output "${out}" PARENT_SCOPE)
endfunction()

file(REMOVE_RECURSE ${WORK_DIR})
set(prefix ${WORK_DIR}/prefix)
run(${CMAKE_COMMAND} --install ${BUILD_DIR} --prefix ${prefix})
run(${CMAKE_COMMAND} -S ${EXAMPLE_DIR} -B ${WORK_DIR}/build -G ${GENERATOR}
    -DCMAKE_PREFIX_PATH=${prefix} -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
    -DCMAKE_CXX_FLAGS=${CXX_FLAGS} -DCMAKE_BUILD_TYPE=${BUILD_TYPE})
run(${CMAKE_COMMAND} --build ${WORK_DIR}/build)

set(bin ${prefix}/${BINDIR})
set(drive ${WORK_DIR}/drive)
run(${bin}/simulate-drive --out ${drive} --frames 0:6 --seed 3 --size 620x188)
run(${bin}/kitti2rawlog --input ${drive} --out ${drive}/drive.rawlog --labels none)
run(${WORK_DIR}/build/robot_app ${prefix}/${DATADIR}/djpete-slam/datasets_cfg/simulated.ini
    ${drive}/drive.rawlog)
foreach(expected "frame 0: " "frame 5: " "object [0-9]+: (Car|Van)")
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "robot_app did not print '${expected}':\n${output}")
  endif()
endforeach()
