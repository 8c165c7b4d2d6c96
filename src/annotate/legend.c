/* The legend of a datum: its name, and the colours that stand for its values. */
#include <math.h>
#include <stdio.h>

#include "annotate/annotate_private.h"
#include "export/export.h"

enum { RAMP_STEPS = 24 };

static colour mixed(colour a, colour b, float f)
{
    return (colour){a.r + f * (b.r - a.r), a.g + f * (b.g - a.g), a.b + f * (b.b - a.b), 1};
}

/* What parts without an entry's colour are called; NULL: there are none that have the same colour for it. */
static const char *rest_of(const datum *d)
{
    return !(d->other.a > 0) ? NULL
           : d->beyond_count ? (d->other_count ? "others, no value" : "others")
           : d->other_count  ? "no value"
                             : NULL;
}

/* The longest line, its letters alone. */
static lmn_status measure(const annotation *a, double *out, lmn_error *error)
{
    const datum *d = &a->view->plan->datum;
    lmn_status   status = export_text_width(out, a->view->plan->datum.name, a->letter, error);
    for (size_t i = 0; i < d->entry_count && status == LMN_OK; i++) {
        double width;
        status = export_text_width(&width, d->entries[i].text, a->letter, error);
        *out = fmax(*out, status == LMN_OK ? width + 2.4 * a->letter : 0);
    }
    if (rest_of(d) && status == LMN_OK) {
        double width = 0;
        status = export_text_width(&width, rest_of(d), a->letter, error);
        *out = fmax(*out, width + 2.4 * a->letter);
    }
    return status;
}

static void put_ramp(annotation *a, double left, double top, double row)
{
    const datum *d = &a->view->plan->datum;
    double       high = row * (double)(d->entry_count - 1), step = high / RAMP_STEPS;
    for (int i = 0; i < RAMP_STEPS; i++) {
        float  at = ((float)i + 0.5f) / RAMP_STEPS * (float)(d->entry_count - 1);
        size_t low = (size_t)at;
        /* Down to the end, so that no border between two steps shows what lies below. */
        annotation_fill(a, mixed(d->entries[low].colour, d->entries[low + 1].colour, at - (float)low), left,
                        top + step * i, left + 1.6 * a->letter, top + high);
    }
    sheet_add_rectangle(a->page, a->group, a->ink, left, top, 1.6 * a->letter, high, a->letter * 0.05);
}

static void put_rows(annotation *a, double left, double top, double row)
{
    const datum *d = &a->view->plan->datum;
    double       swatch = 1.6 * a->letter, line = a->letter * 0.05;
    const char  *rest = rest_of(d);
    bool         ramp = d->is_ramp && d->entry_count > 1;
    if (ramp)
        put_ramp(a, left, top + 0.5 * row, row);
    for (size_t i = 0; i < d->entry_count + (rest ? 1 : 0); i++) {
        double middle = top + ((double)i + 0.5) * row, high = 0.4 * row;
        bool   last = i == d->entry_count;
        if (!ramp || last) {
            annotation_fill(a, last ? d->other : d->entries[i].colour, left, middle - high, left + swatch,
                            middle + high);
            sheet_add_rectangle(a->page, a->group, a->ink, left, middle - high, swatch, 2 * high, line);
        }
        sheet_add_text(a->page, a->group, a->ink, last ? rest : d->entries[i].text, left + swatch + 0.8 * a->letter,
                       middle + 0.36 * a->letter, a->letter, -1);
    }
}

lmn_status annotate_legend(annotation *a, lmn_error *error)
{
    const datum  *d = &a->view->plan->datum;
    const double *page = a->view->box;
    double        width, row = 1.5 * a->letter, inset = 0.9 * a->letter;
    if (!d->colours || d->entry_count == 0)
        return LMN_OK;
    lmn_status status = measure(a, &width, error);
    if (status != LMN_OK)
        return status;
    double high = row * ((double)d->entry_count + (rest_of(d) ? 1 : 0)) + 1.9 * a->letter;
    double left = page[0] + 1.5 * a->letter, bottom = page[1] + page[3] - 1.5 * a->letter;
    double box[4] = {left, bottom - high - 2 * inset, left + width + 2 * inset, bottom};
    annotation_fill(a, a->paper, box[0], box[1], box[2], box[3]);
    sheet_add_rectangle(a->page, a->group, a->ink, box[0], box[1], box[2] - box[0], box[3] - box[1], a->letter * 0.07);
    sheet_add_text(a->page, a->group, a->ink, d->name, left + inset, box[1] + inset + 0.8 * a->letter, a->letter, -1);
    put_rows(a, left + inset, box[1] + inset + 1.7 * a->letter, row);
    annotation_take(a, box);
    return LMN_OK;
}
