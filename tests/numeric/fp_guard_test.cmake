# A build with fast-math must fail, with our message. Run with -DCXX= -DINCLUDE= -DEIGEN= -DWORK=.
file(WRITE ${WORK}/fp_guard_probe.cc "#include \"cguide/numeric/fp_guard.h\"\nint main() {}\n")
foreach(options "-O2" "-O2;-ffast-math" "-O2;-ffinite-math-only")
  execute_process(COMMAND ${CXX} -std=c++20 ${options} -I${INCLUDE} -fsyntax-only ${WORK}/fp_guard_probe.cc
    RESULT_VARIABLE code ERROR_VARIABLE message)
  if(options STREQUAL "-O2")
    if(NOT code EQUAL 0)
      message(FATAL_ERROR "the guard refuses a sound build: ${message}")
    endif()
  elseif(code EQUAL 0 OR NOT message MATCHES "error bounds do not hold")
    message(FATAL_ERROR "${options} was not refused: ${message}")
  endif()
endforeach()
