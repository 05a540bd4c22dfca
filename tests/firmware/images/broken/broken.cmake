# SPDX-License-Identifier: Apache-2.0
# broken(NAME WRAP symbol...): the image of ${board} linked with the shim broken/NAME.c, as NAME.bin.
function(broken name)
    cmake_parse_arguments(B "" "" "WRAP" ${ARGN})
    set(folder ${PROJECT_SOURCE_DIR}/hal/boards/${board})
    set(CMAKE_CURRENT_SOURCE_DIR ${folder}) # where bqhost_image() looks for the linker script and the headers
    file(GLOB sources ${folder}/*.c)
    bqhost_board(${name} ${family} ${sources} ${PROJECT_SOURCE_DIR}/tests/firmware/images/broken/${name}.c)
    target_include_directories(${name} PRIVATE ${PROJECT_SOURCE_DIR}/tests/firmware/images/broken)
    foreach(symbol ${B_WRAP})
        target_link_options(${name} PRIVATE -Wl,--wrap=${symbol})
    endforeach()
endfunction()

broken(hang WRAP bq_firmware_step)
broken(fed_by_irq WRAP bq_firmware_step stm32_time_irq)
broken(no_watchdog WRAP bq_firmware_step stm32_watchdog_start)
broken(never_fed WRAP stm32_watchdog_feed)
broken(no_clock WRAP stm32_can_bus)
broken(flag_kept WRAP stm32_exti_take)
broken(guard_hit WRAP bq_firmware_step)
broken(overflow WRAP bq_firmware_step)
