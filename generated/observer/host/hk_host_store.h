/* The non-volatile store of the host program: a file. */
#ifndef HK_HOST_STORE_H
#define HK_HOST_STORE_H

#include <stdbool.h>

/* Read a file, whose first bytes may be missing or which may be NULL, and keep it as the store is.
 * The supply fails once so many bytes have been written; -1 is never. False if it cannot be read. */
bool hk_host_store_open(const char *path, long power_cut);

#endif
