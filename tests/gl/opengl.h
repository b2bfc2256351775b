// OpenGL's functions, as libOSMesa exports them: nothing has to be loaded by name.
#pragma once

#define GL_GLEXT_PROTOTYPES
#include <GL/osmesa.h>
// after osmesa.h, which brings gl.h
#include <GL/glext.h>
