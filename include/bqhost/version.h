/* SPDX-License-Identifier: Apache-2.0 */
/**
 * @file version.h
 * The version of this project, in this one place: CMake reads it from here, images and tools print it.
 */
#ifndef BQHOST_VERSION_H
#define BQHOST_VERSION_H

#define BQHOST_VERSION "0.1.0"

#endif
