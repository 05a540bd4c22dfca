# SPDX-License-Identifier: Apache-2.0
# Toolchain file for the STM32 boards: clang and lld, with the headers, C library and compiler helpers of GNU Arm.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES BQHOST_CPU)
find_program(BQHOST_ARM_CLANG NAMES clang-19 clang REQUIRED)
set(CMAKE_C_COMPILER ${BQHOST_ARM_CLANG})
set(CMAKE_C_COMPILER_TARGET arm-none-eabi)

function(bqhost_ask_gcc variable) # a path that the GNU compiler prints for this core
    execute_process(COMMAND arm-none-eabi-gcc -mcpu=${BQHOST_CPU} -mthumb -mfloat-abi=soft ${ARGN}
        OUTPUT_VARIABLE path OUTPUT_STRIP_TRAILING_WHITESPACE COMMAND_ERROR_IS_FATAL ANY)
    set(${variable} ${path} PARENT_SCOPE)
endfunction()

bqhost_ask_gcc(libc -print-file-name=libc_nano.a)
bqhost_ask_gcc(libgcc -print-libgcc-file-name)
execute_process(COMMAND sh -c "arm-none-eabi-gcc -E -Wp,-v -xc - </dev/null 2>&1 | sed -n 's/^ \\(.*arm-none-eabi\\/include\\)$/\\1/p'"
    OUTPUT_VARIABLE headers OUTPUT_STRIP_TRAILING_WHITESPACE)
set(CMAKE_C_FLAGS_INIT "-mcpu=${BQHOST_CPU} -mthumb -mfloat-abi=soft -isystem ${headers}")
find_program(BQHOST_OBJCOPY NAMES llvm-objcopy-19 llvm-objcopy arm-none-eabi-objcopy REQUIRED)
# Measured on hv-f405: the running pointers and counters that strength reduction adds to loops cost 1.8 KB.
set(BQHOST_IMAGE_LINK -fuse-ld=lld -nostdlib -Wl,--icf=all -Wl,-mllvm,-disable-lsr)
set(BQHOST_IMAGE_LIBS ${libc} ${libgcc})
# clang's -Os is meant for speed too: its image would not fit.
set(CMAKE_C_FLAGS_MINSIZEREL "-Oz -DNDEBUG -flto" CACHE STRING "")
