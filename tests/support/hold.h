/* Looks in which conditions on parameters hold. */
#ifndef TESTS_HOLD_H
#define TESTS_HOLD_H

#include "look/look.h"

/* Where `lmn_look_set` finds a parameter of the first rule, or of the whole look. */
enum { HOLD_KEY_SIZE = 192 };
void hold_key(char key[HOLD_KEY_SIZE], const kind *k, const char *param_key);

/* Sets parameters of the technique so that each term of the condition holds (NULL: nothing to do): "key",
 * "key=word,word", "key>number", "key<number". A term that cannot be made to hold is a failure of the test that
 * runs. */
void hold_condition(lmn_look *look, const kind *k, const technique *t, const char *condition);

/* Leaves out of a technique's example what only takes time, but for the parameter with this key. Returns which of all
 * such things it left out, so that pictures are compared only with those of equal looks. */
uint32_t hold_lighter(lmn_look *look, const kind *k, const technique *t, const char *param_key);

#endif
