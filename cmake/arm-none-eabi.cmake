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
