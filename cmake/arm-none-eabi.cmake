# SPDX-License-Identifier: Apache-2.0
# Toolchain file for the STM32 boards: GNU Arm (arm-none-eabi-gcc with newlib). BQHOST_CPU names the core.
set(CMAKE_SYSTEM_NAME Generic)
set(CMAKE_SYSTEM_PROCESSOR arm)
set(CMAKE_TRY_COMPILE_TARGET_TYPE STATIC_LIBRARY)
set(CMAKE_TRY_COMPILE_PLATFORM_VARIABLES BQHOST_CPU)
set(CMAKE_C_COMPILER arm-none-eabi-gcc)
set(CMAKE_C_FLAGS_INIT "-mcpu=${BQHOST_CPU} -mthumb -mfloat-abi=soft")
set(BQHOST_OBJCOPY arm-none-eabi-objcopy)
set(BQHOST_IMAGE_LINK -nostartfiles --specs=nano.specs)
# Measured on hv-f405: tables of jumps and values kept over loops cost 700 bytes that nothing here is waiting for.
set(CMAKE_C_FLAGS_MINSIZEREL_INIT "-fno-jump-tables -fno-tree-loop-im -fno-move-loop-invariants")
