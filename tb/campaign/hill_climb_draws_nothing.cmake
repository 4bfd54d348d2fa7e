# One start of a family may cover nothing: hill_climb says so and ends with status 2, not as if a bound were exceeded.
execute_process(COMMAND ${PROGRAM} --starts 1 --steps 1 --significand-bits 12 RESULT_VARIABLE status OUTPUT_VARIABLE out ERROR_VARIABLE err)
if(NOT status EQUAL 2 OR NOT err MATCHES "nothing was drawn, so nothing was shown, of [a-z_]+ .*more --starts than 1")
  message(FATAL_ERROR "status ${status}\n${out}\n${err}")
endif()
