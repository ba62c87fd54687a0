# Installs BUILD into a fresh folder below WORK, then configures, builds and runs two other projects that find it there.
file(REMOVE_RECURSE ${WORK})
file(MAKE_DIRECTORY ${WORK})

function(run)
  execute_process(COMMAND ${ARGN} RESULT_VARIABLE status)
  if(NOT status EQUAL 0)
    list(JOIN ARGN " " command)
    message(FATAL_ERROR "failed (${status}): ${command}")
  endif()
endfunction()

run(${CMAKE_COMMAND} --install ${BUILD} --prefix ${WORK}/prefix)

set(flags)
if(SANITIZE)
  set(flags -fsanitize=${SANITIZE}) # the installed archives need the sanitizers' runtime
endif()
foreach(project consumer example)
  string(TOUPPER ${project} source)
  run(${CMAKE_COMMAND} -S ${${source}} -B ${WORK}/${project} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${COMPILER}
      -DCMAKE_CXX_FLAGS=${flags} -DCMAKE_PREFIX_PATH=${WORK}/prefix -DCMAKE_BUILD_TYPE=Release)
  run(${CMAKE_COMMAND} --build ${WORK}/${project})
endforeach()
run(${WORK}/consumer/consumer)
run(${WORK}/example/render_to_memory ${WORK}/example.png)
if(NOT EXISTS ${WORK}/example.png)
  message(FATAL_ERROR "the example wrote no picture")
endif()

if(APPS)
  run(${WORK}/prefix/bin/steradian --version)
endif()
