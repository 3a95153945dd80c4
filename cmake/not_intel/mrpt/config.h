// Debian packs MRPT's config.h, made on a PC, for all processors; elsewhere it asks for SSE headers that are not there.
#pragma once
#include_next <mrpt/config.h>
#undef MRPT_ARCH_INTEL_COMPATIBLE
#define MRPT_ARCH_INTEL_COMPATIBLE 0
