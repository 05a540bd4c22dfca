# SPDX-License-Identifier: Apache-2.0
# bqhost_board(BOARD FAMILY SOURCES...): the firmware image of a board with the main program of all boards.
# bqhost_image(BOARD FAMILY SOURCES...): any image, BOARD.elf, .bin, .hex and .map in the build
# folder. The board's folder holds link.ld; tools/imagecrc.py writes length and checksum into the image's header.
find_package(Python3 REQUIRED COMPONENTS Interpreter)

function(bqhost_board board family)
    bqhost_image(${board} ${family} ${PROJECT_SOURCE_DIR}/hal/boards/board_main.c ${ARGN})
    target_include_directories(${board} PRIVATE ${PROJECT_SOURCE_DIR}/hal/boards)
endfunction()

function(bqhost_image board family)
    set(common ${PROJECT_SOURCE_DIR}/hal/stm32)
    set(out ${PROJECT_BINARY_DIR}/${board})
    math(EXPR version "(${PROJECT_VERSION_MAJOR} << 16) + (${PROJECT_VERSION_MINOR} << 8) + ${PROJECT_VERSION_PATCH}")

    add_executable(${board} ${ARGN})
    set_target_properties(${board} PROPERTIES SUFFIX .elf RUNTIME_OUTPUT_DIRECTORY ${PROJECT_BINARY_DIR}
        C_EXTENSIONS OFF LINK_DEPENDS "${CMAKE_CURRENT_SOURCE_DIR}/link.ld;${common}/sections.ld")
    target_compile_features(${board} PRIVATE c_std_99)
    target_include_directories(${board} PRIVATE ${CMAKE_CURRENT_SOURCE_DIR})
    # The header of the image carries the board's name, so it is compiled here and not in the back-end.
    target_sources(${board} PRIVATE ${common}/stm32_header.c)
    target_compile_definitions(${board} PRIVATE BQHOST_BOARD="${board}" BQHOST_IMAGE_VERSION=${version}u)
    target_link_libraries(${board} PRIVATE bqhost bqhost_hal_${family} bqhost_flags ${BQHOST_IMAGE_LIBS})
    target_link_options(${board} PRIVATE ${BQHOST_IMAGE_LINK} -Wl,--gc-sections -Wl,-Map=${out}.map
        -L${common} -T${CMAKE_CURRENT_SOURCE_DIR}/link.ld)

    add_custom_command(TARGET ${board} POST_BUILD
        COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/imagecrc.py seal $<TARGET_FILE:${board}>
        COMMAND ${BQHOST_OBJCOPY} -O binary $<TARGET_FILE:${board}> ${out}.bin
        COMMAND ${BQHOST_OBJCOPY} -O ihex $<TARGET_FILE:${board}> ${out}.hex
        COMMAND ${Python3_EXECUTABLE} ${PROJECT_SOURCE_DIR}/tools/imagecrc.py check ${out}.bin
        BYPRODUCTS ${out}.bin ${out}.hex ${out}.map VERBATIM)
endfunction()
