// A window by GLFW in which Dear ImGui draws, and the one picture in it.
#pragma once

#include "core/image.h"

#include <filesystem>

struct GLFWwindow;

namespace ssrlab {

class Window {
public:
    /// Throws Failure where no window can be opened.
    Window(const char* title, glm::ivec2 size_px);
    Window(const Window&)            = delete;
    Window& operator=(const Window&) = delete;
    ~Window();

    bool is_closed() const;
    /// Waits for input at most so long, then begins a frame of Dear ImGui.
    void begin_frame(double wait_s);
    void draw();
    /// What draw() drew, as a .png or .exr.
    void screenshot(const std::filesystem::path& file) const;
    void present();

    /// Linear display light of three channels.
    void  set_picture(const Image& picture);
    void* picture() const; // as Dear ImGui names it

private:
    GLFWwindow* window_  = nullptr;
    unsigned    texture_ = 0;
};

} // namespace ssrlab
