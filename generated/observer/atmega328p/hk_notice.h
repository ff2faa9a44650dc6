/* Tells in STATUSTEXT what has happened. */
#ifndef HK_NOTICE_H
#define HK_NOTICE_H

#include "hk_app.h"

/* Tell one thing that has not been told, if there is room. */
void hk_notice_poll(hk_app_t *app);

#endif
