#include "security/documents.hpp"

#include <cstdio>
#include <ctime>

#include <tinyxml2.h>

namespace fathom::security {
namespace {

using tinyxml2::XMLDocument;
using tinyxml2::XMLElement;
using tinyxml2::XMLPrinter;

void leaf(XMLPrinter& xml, const char* name, const std::string& text) {
  xml.OpenElement(name);
  xml.PushText(text.c_str());
  xml.CloseElement();
}

void open_document(XMLPrinter& xml) {
  xml.PushHeader(false, true);
  xml.OpenElement("dds");
}

void domains_element(XMLPrinter& xml, const Domains& domains) {
  xml.OpenElement("domains");
  xml.OpenElement("id_range");
  leaf(xml, "min", std::to_string(domains.first));
  leaf(xml, "max", std::to_string(domains.last));
  xml.CloseElement();
  xml.CloseElement();
}

void topics_element(XMLPrinter& xml, const char* direction, const std::vector<std::string>& topics) {
  if (topics.empty()) return;
  xml.OpenElement(direction);
  xml.OpenElement("topics");
  for (const std::string& topic : topics) leaf(xml, "topic", topic);
  xml.CloseElement();
  xml.CloseElement();
}

std::string date(TimeNs utc) {
  const std::string text = to_iso8601(utc, 0);
  return text.substr(0, text.find('Z'));
}

/// Reads one document and says where it stopped making sense.
class Reading {
 public:
  Reading(const std::string& xml, const std::string& place) : place_(place) {
    if (document_.Parse(xml.data(), xml.size()) != tinyxml2::XML_SUCCESS ||
        document_.RootElement() == nullptr) {
      throw SecurityError(place + ": is not XML, expected a document as fathom keygen writes");
    }
  }
  [[nodiscard]] const XMLElement& root() const { return *document_.RootElement(); }
  [[nodiscard]] const XMLElement& child(const XMLElement& parent, const char* name) const {
    const XMLElement* found = parent.FirstChildElement(name);
    if (found == nullptr) {
      throw SecurityError(place_ + ": " + parent.Name() + ": has no " + name +
                          ", expected a document as fathom keygen writes");
    }
    return *found;
  }
  [[nodiscard]] std::string text(const XMLElement& parent, const char* name) const {
    const char* text = child(parent, name).GetText();
    return text == nullptr ? "" : text;
  }
  [[nodiscard]] Domains domains(const XMLElement& parent) const {
    const XMLElement& range = child(child(parent, "domains"), "id_range");
    Domains out;
    if (child(range, "min").QueryUnsignedText(&out.first) != tinyxml2::XML_SUCCESS ||
        child(range, "max").QueryUnsignedText(&out.last) != tinyxml2::XML_SUCCESS) {
      throw SecurityError(place_ + ": id_range: holds no numbers, expected DDS domains");
    }
    return out;
  }
  [[nodiscard]] TimeNs instant(const XMLElement& parent, const char* name) const {
    const std::string written = text(parent, name);
    CivilTime civil;
    const bool complete = std::sscanf(written.c_str(), "%d-%d-%dT%d:%d:%d", &civil.year, &civil.month,
                                      &civil.day, &civil.hour, &civil.minute, &civil.second) == 6;
    const auto utc = complete ? from_civil(civil) : std::nullopt;
    if (!utc) throw SecurityError(place_ + ": " + name + ": is '" + written + "', expected a date and time");
    return *utc;
  }

 private:
  XMLDocument document_;
  std::string place_;
};

std::vector<std::string> topics_of(const XMLElement& rule, const char* direction) {
  std::vector<std::string> out;
  for (const XMLElement* way = rule.FirstChildElement(direction); way != nullptr;
       way = way->NextSiblingElement(direction)) {
    const XMLElement* topics = way->FirstChildElement("topics");
    if (topics == nullptr) continue;
    for (const XMLElement* topic = topics->FirstChildElement("topic"); topic != nullptr;
         topic = topic->NextSiblingElement("topic")) {
      if (topic->GetText() != nullptr) out.emplace_back(topic->GetText());
    }
  }
  return out;
}

}  // namespace

std::string governance_xml(const Domains& domains, MessageProtection protection) {
  XMLPrinter xml;
  open_document(xml);
  xml.OpenElement("domain_access_rules");
  xml.OpenElement("domain_rule");
  domains_element(xml, domains);
  leaf(xml, "allow_unauthenticated_participants", "false");
  leaf(xml, "enable_join_access_control", "true");
  leaf(xml, "discovery_protection_kind", "ENCRYPT");
  leaf(xml, "liveliness_protection_kind", "ENCRYPT");
  leaf(xml, "rtps_protection_kind", protection == MessageProtection::sign ? "SIGN" : "ENCRYPT");
  xml.OpenElement("topic_access_rules");
  xml.OpenElement("topic_rule");
  leaf(xml, "topic_expression", "*");
  leaf(xml, "enable_discovery_protection", "true");
  leaf(xml, "enable_liveliness_protection", "true");
  leaf(xml, "enable_read_access_control", "true");
  leaf(xml, "enable_write_access_control", "true");
  // The message around it is protected as a whole.
  leaf(xml, "metadata_protection_kind", "NONE");
  leaf(xml, "data_protection_kind", "ENCRYPT");
  for (int open_elements = 5; open_elements > 0; --open_elements) xml.CloseElement();
  return xml.CStr();
}

Governance governance_from_xml(const std::string& xml, const std::string& place) {
  const Reading reading(xml, place);
  const XMLElement& rule = reading.child(reading.child(reading.root(), "domain_access_rules"), "domain_rule");
  const std::string kind = reading.text(rule, "rtps_protection_kind");
  if (kind != "SIGN" && kind != "ENCRYPT") {
    throw SecurityError(place + ": rtps_protection_kind: is '" + kind + "', expected SIGN or ENCRYPT");
  }
  return {reading.domains(rule), kind == "SIGN" ? MessageProtection::sign : MessageProtection::encrypt};
}

std::string permissions_xml(const Grant& grant) {
  XMLPrinter xml;
  open_document(xml);
  xml.OpenElement("permissions");
  xml.OpenElement("grant");
  xml.PushAttribute("name", grant.name.c_str());
  leaf(xml, "subject_name", grant.subject);
  xml.OpenElement("validity");
  leaf(xml, "not_before", date(grant.validity.from_ns));
  leaf(xml, "not_after", date(grant.validity.until_ns));
  xml.CloseElement();
  xml.OpenElement("allow_rule");
  domains_element(xml, grant.domains);
  topics_element(xml, "publish", grant.publishes);
  topics_element(xml, "subscribe", grant.subscribes);
  xml.CloseElement();
  leaf(xml, "default", "DENY");
  for (int open_elements = 3; open_elements > 0; --open_elements) xml.CloseElement();
  return xml.CStr();
}

Grant grant_from_xml(const std::string& xml, const std::string& place) {
  const Reading reading(xml, place);
  const XMLElement& element = reading.child(reading.child(reading.root(), "permissions"), "grant");
  const XMLElement& validity = reading.child(element, "validity");
  const XMLElement& rule = reading.child(element, "allow_rule");
  Grant grant;
  const char* name = element.Attribute("name");
  grant.name = name == nullptr ? "" : name;
  grant.subject = reading.text(element, "subject_name");
  grant.validity = {reading.instant(validity, "not_before"), reading.instant(validity, "not_after")};
  grant.domains = reading.domains(rule);
  grant.publishes = topics_of(rule, "publish");
  grant.subscribes = topics_of(rule, "subscribe");
  return grant;
}

}  // namespace fathom::security
