/* What the link of the host program receives and sends. */
#ifndef HK_HOST_LINK_H
#define HK_HOST_LINK_H

#include <stdbool.h>
#include <stdint.h>

/* Receive what a file says, or NULL for nothing. Returns false if it cannot be read. Its form: a
 * float64, the time in s, a uint32, how many bytes, and the bytes; and so on. */
bool hk_host_link_play(const char *path);

/* Receive what comes on standard input, without waiting for it. */
void hk_host_link_listen(void);

/* When the next byte comes, ns; UINT64_MAX if none is planned. */
uint64_t hk_host_link_next_ns(void);

/* Take the next byte that has come by now. */
bool hk_host_link_take(uint64_t now_ns, uint8_t *byte);

/* Write to standard output; flush returns false if nobody reads any more. */
void hk_host_link_put(const uint8_t *bytes, uint8_t count);
bool hk_host_link_flush(void);

/* Forget what has come and not been taken: a receiver that starts anew. */
void hk_host_link_drop(uint64_t now_ns);

#endif
