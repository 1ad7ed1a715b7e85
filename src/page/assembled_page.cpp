// assembled_page.cpp: a record, its arrays and the embedded files as one page.
#include "page/assembled_page.h"

#include "page/page_texts.h"
#include "plot/colour_map.h"

namespace espdiff {
namespace {

using PageJson = nlohmann::ordered_json;

PageJson colour(Rgb rgb) { return {rgb.red, rgb.green, rgb.blue}; }

void add_scales(PageJson& page) {
  constexpr int kColours = 255;
  PageJson names = {"red-blue", "cool-warm", "purple-orange"}, scales = PageJson::object();
  for (const PageJson& name : names) {
    const DivergingMap& map = diverging_map(name.get<std::string>());
    PageJson& scale = scales[name.get<std::string>()] = PageJson::array();
    for (int i = 0; i < kColours; ++i) scale.push_back(colour(diverging_colour(i / (kColours - 1.0), map)));
  }
  PageJson& magnitude = scales["magnitude"] = PageJson::array();
  for (int i = 0; i < kColours; ++i) magnitude.push_back(colour(sequential_colour(i / (kColours - 1.0))));
  page["diverging"] = std::move(names);
  page["scales"] = std::move(scales);
  page["no_value"] = colour(kNoValueColour);
}

/// JSON that cannot end the script element it stands in.
std::string embedded(const PageJson& json) {
  std::string text;
  for (const char c : json.dump(-1, ' ', false, PageJson::error_handler_t::replace)) {
    if (c == '<')
      text += "\\u003c";
    else
      text += c;
  }
  return text;
}

}  // namespace

std::string assembled_page(nlohmann::ordered_json page, const PageArrays& arrays, const std::string& body,
                           const std::vector<std::string>& scripts, const std::vector<std::string>& library) {
  const auto& files = page_texts();
  add_scales(page);
  page["deflated"] = PageArrays::is_deflated();
  std::string script_texts;
  std::string library_text;
  for (const std::string& name : library) library_text += files.at(name) + '\n';
  if (!library.empty())
    script_texts =
        "<!-- three.js, copyright its authors, MIT licence -->\n<script type=\"application/octet-stream\" "
        "id=\"library\">" +
        PageArrays::packed(library_text) + "</script>\n";
  for (const std::string& name : scripts) script_texts += "<script>\n" + files.at(name) + "\n</script>\n";
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n<meta name=\"viewport\" "
         "content=\"width=device-width, initial-scale=1\">\n"
         // Nothing is fetched, whatever the texts of a result hold.
         "<meta http-equiv=\"Content-Security-Policy\" content=\"default-src 'none'; script-src 'unsafe-inline'; "
         "style-src 'unsafe-inline'; img-src data: blob:\">\n<title>espdiff</title>\n<style>\n" +
         files.at("report.css") + "</style>\n</head>\n<body>\n" + files.at(body) +
         "<noscript>This page draws by JavaScript.</noscript>\n"
         "<script type=\"application/json\" id=\"record\">" +
         embedded(page) + "</script>\n<script type=\"application/octet-stream\" id=\"arrays\">" + arrays.base64() +
         "</script>\n" + script_texts + "</body>\n</html>\n";
}

}  // namespace espdiff
