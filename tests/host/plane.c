#include "plane.h"

#include <math.h>
#include <string.h>

static double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

static void cross3(const double a[3], const double b[3], double out[3])
{
    for (int k = 0; k < 3; k++)
        out[k] = a[(k + 1) % 3] * b[(k + 2) % 3] - a[(k + 2) % 3] * b[(k + 1) % 3];
}

static void normalise3(double v[3])
{
    double length = sqrt(dot3(v, v));
    for (int k = 0; k < 3; k++)
        v[k] /= length;
}

static void look_from(plane *p, const double eye[3])
{
    double back[3] = {eye[0], eye[1], eye[2]}, up[3] = {0, 1, 0}, right[3];
    normalise3(back);
    cross3(up, back, right);
    normalise3(right);
    cross3(back, right, up);
    const double *rows[3] = {right, up, back};
    memset(p->view, 0, sizeof p->view);
    for (int i = 0; i < 3; i++) {
        for (int k = 0; k < 3; k++)
            p->view[4 * k + i] = rows[i][k];
        p->view[12 + i] = -dot3(rows[i], eye);
    }
    p->view[15] = 1;
}

/* Near 0.5, far 50; reversed: 1 … 0 in a clip space of 0 … 1. */
static void project(plane *p)
{
    const double near = 0.5, far = 50, scale = p->orthographic ? 0.9 : 2.2;
    double      *m = p->projection;
    memset(m, 0, sizeof p->projection);
    m[0] = m[5] = scale;
    if (p->orthographic) {
        m[10] = p->depth == PLANE_REVERSED ? 1 / (far - near) : -2 / (far - near);
        m[14] = p->depth == PLANE_REVERSED ? far / (far - near) : -(far + near) / (far - near);
        m[15] = 1;
    } else {
        m[10] = p->depth == PLANE_REVERSED ? near / (far - near) : -(far + near) / (far - near);
        m[14] = p->depth == PLANE_REVERSED ? near * far / (far - near) : -2 * far * near / (far - near);
        m[11] = -1;
    }
}

static GLuint shader(GLenum stage, const char *body)
{
    GLuint      name = glCreateShader(stage);
    const char *parts[] = {epoxy_is_desktop_gl() ? "#version 330 core\n" : "#version 300 es\nprecision highp float;\n",
                           body};
    glShaderSource(name, 2, parts, NULL);
    glCompileShader(name);
    return name;
}

void plane_open(plane *p, plane_depth depth, bool orthographic, double shift)
{
    float        corners[4][3];
    const double eye[3] = {2.1, 1.7, 2.9}, across[3] = {0.31, 1, -0.2};
    double       sides[2][3];
    *p = (plane){.depth = depth, .orthographic = orthographic, .normal = {0.5, 0.35, 0.79}, .shift = shift};
    normalise3(p->normal);
    look_from(p, eye);
    project(p);
    cross3(p->normal, across, sides[0]);
    normalise3(sides[0]);
    cross3(p->normal, sides[0], sides[1]);
    for (int i = 0; i < 4; i++)
        for (int k = 0; k < 3; k++) {
            p->corners[i][k] =
                shift * p->normal[k] + (i & 1 ? 1.1 : -1.1) * sides[0][k] + (i & 2 ? 0.9 : -0.9) * sides[1][k];
            corners[i][k] = (float)p->corners[i][k];
        }
    GLuint vertex = shader(GL_VERTEX_SHADER,
                           "layout(location = 0) in vec3 position;\n"
                           "uniform mat4 u_view, u_projection;\n"
                           "void main() { gl_Position = u_projection * (u_view * vec4(position, 1.0)); }\n"),
           fragment = shader(GL_FRAGMENT_SHADER, "layout(location = 0) out vec4 out_0;\n"
                                                 "void main() { out_0 = vec4(0.0, 1.0, 0.0, 1.0); }\n");
    p->program = glCreateProgram();
    glAttachShader(p->program, vertex);
    glAttachShader(p->program, fragment);
    glLinkProgram(p->program);
    glDeleteShader(vertex);
    glDeleteShader(fragment);
    glGenVertexArrays(1, &p->array);
    glGenBuffers(1, &p->buffer);
    glBindVertexArray(p->array);
    glBindBuffer(GL_ARRAY_BUFFER, p->buffer);
    glBufferData(GL_ARRAY_BUFFER, sizeof corners, corners, GL_STATIC_DRAW);
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 0, NULL);
    glEnableVertexAttribArray(0);
}

void plane_set_depth(const plane *p)
{
    glEnable(GL_DEPTH_TEST);
    if (p->depth == PLANE_REVERSED)
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    glDepthFunc(p->depth == PLANE_REVERSED ? GL_GEQUAL : GL_LEQUAL);
    glClearDepthf(p->depth == PLANE_REVERSED ? 0 : p->depth == PLANE_RANGE ? 0.75f : 1);
    if (p->depth == PLANE_RANGE)
        glDepthRangef(0.25f, 0.75f);
}

void plane_draw(const plane *p)
{
    float view[16], projection[16];
    for (int i = 0; i < 16; i++) {
        view[i] = (float)p->view[i];
        projection[i] = (float)p->projection[i];
    }
    glUseProgram(p->program);
    glUniformMatrix4fv(glGetUniformLocation(p->program, "u_view"), 1, GL_FALSE, view);
    glUniformMatrix4fv(glGetUniformLocation(p->program, "u_projection"), 1, GL_FALSE, projection);
    glBindVertexArray(p->array);
    glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
}

void plane_close(plane *p)
{
    glDeleteProgram(p->program);
    glDeleteVertexArrays(1, &p->array);
    glDeleteBuffers(1, &p->buffer);
}

static double plane_hit(const plane *p, const double from[3], const double along[3])
{
    double t = (p->shift - dot3(p->normal, from)) / dot3(p->normal, along), sides[2][3], at[3];
    for (int s = 0; s < 2; s++) {
        double inside = 0, length = 0;
        for (int k = 0; k < 3; k++) {
            sides[s][k] = p->corners[s + 1][k] - p->corners[0][k];
            at[k] = from[k] + t * along[k] - p->corners[0][k];
            inside += at[k] * sides[s][k];
            length += sides[s][k] * sides[s][k];
        }
        if (inside < 0 || inside > length)
            return INFINITY;
    }
    return t;
}

static double cube_hit(const double from[3], const double along[3])
{
    double enters = -INFINITY, leaves = INFINITY;
    for (int k = 0; k < 3; k++) {
        double a = (-0.5 - from[k]) / along[k], b = (0.5 - from[k]) / along[k];
        enters = fmax(enters, fmin(a, b));
        leaves = fmin(leaves, fmax(a, b));
    }
    return enters <= leaves ? enters : INFINITY;
}

plane_seen plane_ray(const plane *p, double x, double y, int width, int height)
{
    const double *m = p->view, ndc[2] = {2 * x / width - 1, 2 * y / height - 1};
    double        eye_from[3] = {0, 0, 0}, eye_along[3] = {0, 0, -1}, from[3], along[3];
    for (int k = 0; k < 2; k++)
        (p->orthographic ? eye_from : eye_along)[k] = ndc[k] / p->projection[5 * k];
    for (int k = 0; k < 3; k++) {
        double shifted[3] = {eye_from[0] - m[12], eye_from[1] - m[13], eye_from[2] - m[14]};
        from[k] = m[4 * k] * shifted[0] + m[4 * k + 1] * shifted[1] + m[4 * k + 2] * shifted[2];
        along[k] = m[4 * k] * eye_along[0] + m[4 * k + 1] * eye_along[1] + m[4 * k + 2] * eye_along[2];
    }
    double plane_at = plane_hit(p, from, along), cube_at = cube_hit(from, along);
    return cube_at < plane_at ? SEEN_CUBE : plane_at < INFINITY ? SEEN_PLANE : SEEN_NOTHING;
}
