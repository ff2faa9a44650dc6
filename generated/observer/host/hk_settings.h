/* Changes of parameters on their way: told, put to use, stored. */
#ifndef HK_SETTINGS_H
#define HK_SETTINGS_H

#include "hk_app.h"

/* Begin with the design's values, or with those that are stored. */
void hk_settings_init(hk_app_t *app);

/* Set one parameter, and tell its value, which is the old one if the new one is out of range. */
void hk_settings_set(hk_app_t *app, uint8_t place, float value);

/* Tell the value of one parameter, or of all, one by one. */
void hk_settings_tell(hk_app_t *app, uint8_t place);
void hk_settings_list(hk_app_t *app);

/* Take the values that are stored, of which there may be none, or the design's. */
bool hk_settings_restore(hk_app_t *app);
void hk_settings_reset(hk_app_t *app);

/* Begin to store all values, unless that is under way. */
void hk_settings_save(hk_app_t *app);

/* A calibration has found the mean angular rate at rest, in counts. Returns false if a bias is out
 * of range. */
bool hk_settings_calibrate(hk_app_t *app, const float gyro_count[3]);

/* Tell, put to use and store what is to be. */
void hk_settings_poll(hk_app_t *app);

#endif
