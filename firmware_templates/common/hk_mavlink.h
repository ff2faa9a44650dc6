/* The MAVLink headers with the options of this firmware: one channel, no signing, short payloads.
 * Include this, never the headers themselves. */
#ifndef HK_MAVLINK_H
#define HK_MAVLINK_H

#define MAVLINK_COMM_NUM_BUFFERS 1
#define MAVLINK_NO_SIGN_PACKET
#define MAVLINK_NO_SIGNATURE_CHECK
#define MAVLINK_MAX_PAYLOAD_LEN 64

/* The generated headers do not stand strict warnings. */
#pragma GCC system_header
#include "mavlink/hostkit/mavlink.h"

typedef char hk_payloads_fit[(MAVLINK_MSG_ID_TILT_SAMPLE_LEN <= MAVLINK_MAX_PAYLOAD_LEN
                              && MAVLINK_MSG_ID_STATUSTEXT_LEN <= MAVLINK_MAX_PAYLOAD_LEN)
                                 ? 1
                                 : -1];

#endif
