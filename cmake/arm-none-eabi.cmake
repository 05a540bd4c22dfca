# SPDX-License-Identifier: Apache-2.0
# Toolchain file for the STM32 boards: GNU Arm (arm-none-eabi-gcc with newlib). BQHOST_CPU names the core.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES BQHOST_CPU BQHOST_LTO)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_C_FLAGS_INIT "-mcpu=${BQHOST_CPU} -mthumb -mfloat-abi=soft")
set(BQHOST_OBJCOPY arm-none-eabi-objcopy)
set(BQHOST_IMAGE_LINK -nostartfiles --specs=nano.specs)
# For size, measured on lv-f072: optimised as a whole (which needs the archiver that knows about it), but without copies of
# functions for constant arguments, tables of jumps, values kept over loops, and some passes that cost more than they save.
# BQHOST_LTO=OFF: function by function, for images that put others in the place of functions (--wrap).
set(size_flags -g -fno-jump-tables -fno-tree-loop-im -fno-move-loop-invariants)
if(NOT DEFINED BQHOST_LTO OR BQHOST_LTO)
    list(APPEND size_flags -flto -fno-ipa-cp -fno-ipa-sra -fno-inline-functions-called-once -fno-tree-forwprop
        -fno-tree-scev-cprop -fno-tree-tail-merge)
    set(CMAKE_AR arm-none-eabi-gcc-ar)
    set(CMAKE_RANLIB arm-none-eabi-gcc-ranlib)
endif()
list(JOIN size_flags " " CMAKE_C_FLAGS_MINSIZEREL_INIT)
