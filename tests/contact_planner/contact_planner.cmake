# Installs the build tree into a fresh prefix, builds the contact planner against it, plans a guide and
# lets the planner follow it. Run with -DBUILD= -DSOURCE= -DWORK= -DPROBLEM= -DCXX= -DGENERATOR=.
file(REMOVE_RECURSE ${WORK})
function(run)
  execute_process(COMMAND ${ARGV} RESULT_VARIABLE code OUTPUT_VARIABLE output ERROR_VARIABLE output)
  if(NOT code EQUAL 0)
    message(FATAL_ERROR "exit code ${code}: ${ARGV}\n${output}")
  endif()
  message("${output}")
endfunction()
run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)
run(${CMAKE_COMMAND} -G ${GENERATOR} -S ${SOURCE} -B ${WORK}/build -DCMAKE_BUILD_TYPE=Release
  -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_CXX_COMPILER=${CXX})
run(${CMAKE_COMMAND} --build ${WORK}/build)
run(${WORK}/prefix/bin/cguide plan ${PROBLEM} -o ${WORK}/guide.json --seed 1)
run(${WORK}/build/contact_planner ${PROBLEM} ${WORK}/guide.json --nodes 60 --picture ${WORK}/picture.svg
  --sequence ${WORK}/sequence.json)
run(${WORK}/prefix/bin/cguide view ${WORK}/sequence.json -o ${WORK}/sequence.html)
