# SPDX-License-Identifier: Apache-2.0
# Regenerates the committed thermistor tables and compares, and proves that the generator refuses a table that is too coarse.
find_program(python NAMES python3)
if(NOT python)
    message(STATUS "SKIPPED: python3 is needed to run the generator")
    return()
endif()

function(generate step result output)
    execute_process(
        COMMAND ${python} ${SOURCE}/tools/thermistor.py --r25 10000 --beta 3435 --name bq_thermistor_103at --step ${step}
        RESULT_VARIABLE status OUTPUT_VARIABLE text ERROR_VARIABLE error)
    set(${result} "${status}" PARENT_SCOPE)
    set(${output} "${text}" PARENT_SCOPE)
endfunction()

execute_process(
    COMMAND ${python} ${SOURCE}/tools/thermistor.py --codes --step 2.5 --r25 10000 --beta 3435 --name bq769x0_codes_103at
    RESULT_VARIABLE status OUTPUT_VARIABLE generated)
file(READ ${SOURCE}/src/core/bq769x0_codes_103at.c committed)
if(NOT status EQUAL 0 OR NOT generated STREQUAL committed)
    message(FATAL_ERROR "src/core/bq769x0_codes_103at.c is not what tools/thermistor.py prints")
endif()

file(READ ${SOURCE}/src/core/thermistor_103at.c committed)
generate(1.5 status generated)
if(NOT status EQUAL 0)
    message(FATAL_ERROR "the generator failed: ${status}")
endif()
if(NOT generated STREQUAL committed)
    message(FATAL_ERROR "src/core/thermistor_103at.c is not what tools/thermistor.py prints")
endif()
generate(5 status coarse)
if(status EQUAL 0 OR NOT coarse STREQUAL "")
    message(FATAL_ERROR "the generator printed a table that is wrong by 0.1 degrees or more")
endif()
