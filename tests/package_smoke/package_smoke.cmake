# Installs the build tree into a fresh prefix, builds the consumer against it and runs it.
# Run with -DBUILD= -DSOURCE= -DWORK= -DPROBLEM= -DCXX= -DGENERATOR=.
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "exit code ${code}: ${ARGV}\n${output}")
  endif()
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE} -B ${WORK}/build -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_COMPILER=${CXX})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/build/consumer ${PROBLEM})
run(${WORK}/prefix/bin/cguide --version)
if(EXISTS ${WORK}/build/ompl_consumer)
  run(${WORK}/build/ompl_consumer ${PROBLEM})
endif()
