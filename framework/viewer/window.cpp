#include "viewer/window.h"

#include "compare/image_filter.h"
#include "compare/image_io.h"
#include "core/error.h"

#include <backends/imgui_impl_glfw.h>
#include <backends/imgui_impl_opengl2.h>
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <string>
#include <vector>

namespace ssrlab {
namespace {

constexpr const char* font_file = "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf"; // Debian's fonts-dejavu-core

[[noreturn]] void refuse_window()
{
    const char* why = nullptr;
    glfwGetError(&why);
    const std::string text = why != nullptr ? why : ""; // glfwTerminate() forgets it
    glfwTerminate();
    throw_failure("no window: {}", text);
}

} // namespace

Window::Window(const char* title, glm::ivec2 size_px)
{
    if (glfwInit() == GLFW_FALSE) refuse_window();
    window_ = glfwCreateWindow(size_px.x, size_px.y, title, nullptr, nullptr);
    if (window_ == nullptr) refuse_window();
    glfwMakeContextCurrent(window_);
    glfwSwapInterval(1);
    ImGui::CreateContext();
    ImGui::GetIO().IniFilename = nullptr; // leaves no file behind
    if (std::filesystem::exists(font_file)) ImGui::GetIO().Fonts->AddFontFromFileTTF(font_file, 14);
    ImGui_ImplGlfw_InitForOpenGL(window_, true);
    ImGui_ImplOpenGL2_Init();
    glGenTextures(1, &texture_);
}

Window::~Window()
{
    glDeleteTextures(1, &texture_);
    ImGui_ImplOpenGL2_Shutdown();
    ImGui_ImplGlfw_Shutdown();
    ImGui::DestroyContext();
    glfwDestroyWindow(window_);
    glfwTerminate();
}

bool Window::is_closed() const { return glfwWindowShouldClose(window_) == GLFW_TRUE; }

void Window::begin_frame(double wait_s)
{
    if (wait_s > 0)
        glfwWaitEventsTimeout(wait_s);
    else
        glfwPollEvents();
    ImGui_ImplOpenGL2_NewFrame();
    ImGui_ImplGlfw_NewFrame();
    ImGui::NewFrame();
}

void Window::draw()
{
    ImGui::Render();
    glm::ivec2 size_px(0);
    glfwGetFramebufferSize(window_, &size_px.x, &size_px.y);
    glViewport(0, 0, size_px.x, size_px.y);
    glClearColor(0.1F, 0.1F, 0.1F, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    ImGui_ImplOpenGL2_RenderDrawData(ImGui::GetDrawData());
}

void Window::screenshot(const std::filesystem::path& file) const
{
    Image image;
    image.channels = {"R", "G", "B"};
    glfwGetFramebufferSize(window_, &image.size_px.x, &image.size_px.y);
    const auto           width = static_cast<size_t>(image.size_px.x), height = static_cast<size_t>(image.size_px.y);
    std::vector<uint8_t> bytes(3 * width * height);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(0, 0, image.size_px.x, image.size_px.y, GL_RGB, GL_UNSIGNED_BYTE, bytes.data());
    image.values.reserve(bytes.size());
    for (size_t y = height; y-- > 0;) // OpenGL's first row is the lowest
        for (size_t i = 0; i < 3 * width; ++i)
            image.values.push_back(srgb_to_linear(static_cast<float>(bytes[3 * width * y + i]) / 255));
    write_image(file, image);
}

void Window::present() { glfwSwapBuffers(window_); }

void Window::set_picture(const Image& picture)
{
    const std::vector<uint8_t> bytes = to_srgb8(picture);
    glBindTexture(GL_TEXTURE_2D, texture_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB8, picture.size_px.x, picture.size_px.y, 0, GL_RGB, GL_UNSIGNED_BYTE,
                 bytes.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_NEAREST);
}

// NOLINTNEXTLINE(performance-no-int-to-ptr): Dear ImGui takes the number of a texture as a pointer
void* Window::picture() const { return reinterpret_cast<void*>(static_cast<uintptr_t>(texture_)); }

} // namespace ssrlab
