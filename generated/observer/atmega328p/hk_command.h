/* Carries out COMMAND_LONG and answers it. */
#ifndef HK_COMMAND_H
#define HK_COMMAND_H

#include "hk_app.h"

/* Answer the command that the receiver holds; there must be room for a COMMAND_ACK. */
void hk_command_take(hk_app_t *app);

/* A command that was being carried out is through; the result is a MAV_RESULT. */
void hk_command_end(hk_app_t *app, hk_late_t which, uint8_t result);

/* Answer those that are through, if there is room, and reboot when it is time. */
void hk_command_poll(hk_app_t *app);

#endif
