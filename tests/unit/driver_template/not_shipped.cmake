# SPDX-License-Identifier: Apache-2.0
# usage: cmake -DNM=nm -DLIBRARY=library -DTEMPLATE=the template's own -P not_shipped.cmake
execute_process(COMMAND ${NM} ${TEMPLATE} OUTPUT_VARIABLE template RESULT_VARIABLE failed)
if(failed OR NOT template MATCHES "monitor_template_afe")
    message(FATAL_ERROR "the template cannot be looked at: nothing is proven")
endif()
execute_process(COMMAND ${NM} ${LIBRARY} OUTPUT_VARIABLE library RESULT_VARIABLE failed ERROR_QUIET)
if(failed OR NOT library MATCHES "bq769x0_afe" OR library MATCHES "monitor_template")
    message(FATAL_ERROR "the template is in the library")
endif()
