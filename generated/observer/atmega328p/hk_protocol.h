/* Answers the messages that come over the link. */
#ifndef HK_PROTOCOL_H
#define HK_PROTOCOL_H

#include "hk_app.h"

/* Take some of the bytes that have come; answer at most one message. Returns true if there may be
 * more to take at once. */
bool hk_protocol_poll(hk_app_t *app);

#endif
