/* What the headers of files say of a drawing, in the title block where the caller says nothing. */
#include <stdio.h>
#include <string.h>

#include "base/memory.h"
#include "vector/vector_job.h"

/* What all files that say anything say; NULL: nothing, or different things. */
static const char *fact_of(const lmn_scene *scene, const char *key)
{
    const char *found = NULL;
    for (size_t i = 0; i < scene->node_count; i++)
        for (uint32_t k = 0; k < scene->nodes[i].attribute_count; k++) {
            const attribute *a = &scene->nodes[i].attributes[k];
            if (strcmp(a->key, key) != 0)
                continue;
            if (found && strcmp(found, a->value) != 0)
                return NULL;
            found = a->value;
        }
    return found;
}

static bool is_said(const char *fields, const char *key)
{
    size_t length = strlen(key);
    for (const char *at = fields; at && *at; at += strcspn(at, ";"), at += *at == ';')
        if (strncmp(at, key, length) == 0 && at[length] == '=')
            return true;
    return false;
}

/* What the header says, else what the file is called. Writers put the path of the file where its title belongs. */
static void take_title(vector_job *j)
{
    const char *said = fact_of(j->scene, "file-title"), *title = said;
    if (j->wanted->title && *j->wanted->title)
        return;
    if (!said)
        title = j->scene->file_count ? j->scene->files[0] : "";
    const char *slash = strrchr(title, '/'), *other = strrchr(title, '\\');
    title = slash > other ? slash + 1 : other ? other + 1 : title;
    size_t      length = strlen(title);
    const char *dot = strrchr(title, '.');
    if (dot && dot > title && (!said || (strlen(dot) <= 5 && !strchr(dot, ' '))))
        length = (size_t)(dot - title);
    snprintf(j->title, sizeof j->title, "%.*s", (int)(length < sizeof j->title ? length : sizeof j->title - 1), title);
    if (j->title[0])
        j->filled.title = j->title;
}

/* Of a date with a time the date: "2026-11-01T10:00:00"; of IGES "20261101.100000". */
static int length_of_date(const char *value)
{
    return (int)strcspn(value, "T.");
}

static lmn_status take_fields(vector_job *j, lmn_error *error)
{
    static const char *const rows[][2] = {
        {"file-author", "creator"}, {"file-organisation", "owner"}, {"file-date", "date"}};
    const char *own = j->wanted->fields ? j->wanted->fields : "", *values[3];
    size_t      size = strlen(own) + 1;
    for (int i = 0; i < 3; i++) {
        values[i] = is_said(own, rows[i][1]) ? NULL : fact_of(j->scene, rows[i][0]);
        size += values[i] ? strlen(values[i]) + strlen(rows[i][1]) + 2 : 0;
    }
    j->fields = mem_alloc(size);
    if (!j->fields)
        return error_memory(error);
    snprintf(j->fields, size, "%s", own);
    for (int i = 0; i < 3; i++) {
        size_t used = strlen(j->fields);
        if (!values[i])
            continue;
        int letters = i == 2 ? length_of_date(values[i]) : (int)strlen(values[i]);
        snprintf(j->fields + used, size - used, "%s%s=", used ? ";" : "", rows[i][1]);
        used = strlen(j->fields);
        snprintf(j->fields + used, size - used, "%.*s", letters, values[i]);
        for (char *at = j->fields + used; *at; at++)
            *at = *at == ';' ? ',' : *at; /* which would be the next field */
    }
    j->filled.fields = j->fields;
    return LMN_OK;
}

lmn_status vector_take_header(vector_job *j, lmn_error *error)
{
    if (!j->wanted->frame)
        return LMN_OK;
    j->filled = *j->wanted;
    take_title(j);
    lmn_status status = LMN_OK;
    if (j->wanted->line_group > 0 || (j->wanted->fields && *j->wanted->fields))
        status = take_fields(j, error);
    j->wanted = &j->filled;
    return status;
}
