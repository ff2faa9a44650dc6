/* Layouts, sizes and identities of the MAVLink messages, as mavgen writes them.
 *
 * Include this, never the headers themselves. Frames are made by hk_link and taken apart by
 * hk_receiver: of the headers only structs and constants are used, so nothing of them costs RAM. */
#ifndef HK_MAVLINK_H
#define HK_MAVLINK_H

#define MAVLINK_COMM_NUM_BUFFERS 1
#define MAVLINK_NO_SIGN_PACKET
#define MAVLINK_NO_SIGNATURE_CHECK
#define MAVLINK_MAX_PAYLOAD_LEN 100

/* The generated headers do not stand strict warnings. */
#pragma GCC system_header
#include "mavlink/hostkit/mavlink.h"

#if defined(__BYTE_ORDER__) && __BYTE_ORDER__ != __ORDER_LITTLE_ENDIAN__
#error "the structs are frames only where the lowest byte comes first"
#endif

#endif
