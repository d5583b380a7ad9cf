-- A dissector of what desim {{version}} captures, for Wireshark and tshark:
--   tshark -X lua_script:desim.lua -r trace.pcapng
-- Written by `desim trace --dissector`. Filters: desim.topic == "status", desim_fate.fate == 1 (lost), and the fields of protocols below.

local desim = Proto("desim", "desim message")
local fate = Proto("desim_fate", "desim copy of a message")

local causes = { {{causes}}, [255] = "none" }
local EVERYBODY = 0xffffffff

-- Fields of frames, of all protocols.
local f = {
  sender = ProtoField.uint32("desim.sender", "Sender", base.DEC),
  to = ProtoField.uint32("desim.to", "To", base.DEC, { [EVERYBODY] = "everybody" }),
  number = ProtoField.uint32("desim.frame", "Number of the frame", base.DEC),
  topic = ProtoField.string("desim.topic", "Topic"),
  topic_number = ProtoField.uint8("desim.topic_number", "Number of the topic", base.DEC),
  length = ProtoField.uint16("desim.length", "Bytes of payload", base.DEC),
  padding = ProtoField.bytes("desim.padding", "Header, not modelled"),
  payload = ProtoField.bytes("desim.payload", "Payload"),
}

-- Fields of payloads, protocol by protocol.
local fields = {
{{fields}}}

-- How payloads lie in their bytes.
local kinds = {
{{kinds}}}

local all = {}
for _, field in pairs(f) do all[#all + 1] = field end
for _, field in pairs(fields) do all[#all + 1] = field end
desim.fields = all

local undescribed = ProtoExpert.new("desim.undescribed", "Bytes that do not lie as the protocol says",
  expert.group.MALFORMED, expert.severity.ERROR)
desim.experts = { undescribed }

local description = Field.new("frame.interface_description")

-- What the capture says of an interface: the protocol, the header of messages, the names of topics.
local known = {}
local function interface()
  local words = description()
  words = words and words.value or ""
  if known[words] then return known[words] end
  local about = { kind = string.match(words, "^desim ([^;]*)") or "", topics = {}, topic = 1, length = 2, padding = 0 }
  local topic, length, padding = string.match(words, "message header (%d+),(%d+),(%d+)")
  if topic then
    about.topic, about.length, about.padding = tonumber(topic), tonumber(length), tonumber(padding)
  end
  local number = 0
  for name in string.gmatch(string.match(words, "topics (.*)$") or "", "[^|]+") do
    about.topics[number] = name
    number = number + 1
  end
  known[words] = about
  return about
end

local function varint(buffer, at, stop)
  local number, factor, from = UInt64(0), 0, at
  while at < stop and at - from < 10 do
    local byte = buffer(at, 1):uint()
    number = number:bor(UInt64(byte % 128):lshift(factor))
    factor = factor + 7
    at = at + 1
    if byte < 128 then return number, at end
  end
  return nil
end

-- Reads a field; answers where the next one begins and what it is as a number, or nothing if the bytes do not suffice.
local function take(part, buffer, at, stop, tree)
  local field = fields[part.field]
  local form, bytes = part.form, part.bytes
  if form == "rest" then
    if at < stop then tree:add(field, buffer(at, stop - at)) end
    return stop, 0
  elseif form == "varint" or form == "signed" or form == "text" then
    local number, behind = varint(buffer, at, stop)
    if not number then return nil end
    if form == "text" then
      local length = number:tonumber()
      if behind + length > stop then return nil end
      tree:add(field, buffer(at, behind + length - at), length > 0 and buffer(behind, length):string(ENC_UTF_8) or "")
      return behind + length, 0
    elseif form == "signed" then
      local half = Int64(number:rshift(1):lower(), number:rshift(1):higher())
      if number:band(UInt64(1)) == UInt64(1) then half = -half - Int64(1) end
      tree:add(field, buffer(at, behind - at), half)
      return behind, 0
    end
    tree:add(field, buffer(at, behind - at), number)
    return behind, number:tonumber()
  end
  if at + bytes > stop then return nil end
  local range = buffer(at, bytes)
  if form == "float" then
    tree:add_le(field, range)
    return at + bytes, 0
  elseif form == "little" then
    tree:add_le(field, range)
    return at + bytes, bytes <= 4 and range:le_uint() or range:le_uint64():tonumber()
  end
  tree:add(field, range)
  return at + bytes, bytes <= 4 and range:uint() or range:uint64():tonumber()
end

-- Reads parts; answers where what is behind them begins, or nothing if the bytes do not go on as they should.
local function read(parts, buffer, at, stop, tree)
  for _, part in ipairs(parts) do
    if part.field then
      at = take(part, buffer, at, stop, tree)
      if not at then return nil end
    elseif part.cases then
      if at >= stop then return nil end
      local first, found = buffer(at, 1):uint(), nil
      for _, case in ipairs(part.cases) do
        if case.first <= first and first <= case.last then found = case.parts break end
      end
      if not found then return nil end
      at = read(found, buffer, at, stop, tree)
      if not at then return nil end
    else
      local count
      at, count = take(part.count, buffer, at, stop, tree)
      if not at then return nil end
      for _ = 1, count do
        local before = at
        at = read(part.each, buffer, at, stop, tree)
        if not at then return nil end
        if at == before then break end
      end
    end
  end
  return at
end

-- Reads the messages of a frame from `at` on.
local function messages(buffer, at, pinfo, tree)
  local about = interface()
  local names = {}
  local stop = buffer:len()
  local header = about.topic + about.length + about.padding
  repeat
    if at + header > stop then error("a message's header is cut short") end
    local topic = about.topic > 0 and buffer(at, 1):uint() or 0
    local length = stop - at - header
    if about.length > 0 then length = buffer(at + about.topic, 2):uint() end
    if at + header + length > stop then error("a message's payload is cut short") end
    local name = about.topics[topic] or ("topic " .. topic)
    local item = tree:add(desim, buffer(at, header + length), about.kind .. ", " .. name)
    if about.topic > 0 then
      item:add(f.topic, buffer(at, 1), name)
      item:add(f.topic_number, buffer(at, 1))
    else
      item:add(f.topic, buffer(at, 0), name):set_generated()
    end
    if about.length > 0 then item:add(f.length, buffer(at + about.topic, 2)) end
    if about.padding > 0 then item:add(f.padding, buffer(at + about.topic + about.length, about.padding)) end
    at = at + header
    if length > 0 then
      local payload = item:add(f.payload, buffer(at, length))
      local parts = kinds[about.kind]
      if parts and #parts > 0 and read(parts, buffer, at, at + length, item) ~= at + length then
        payload:add_proto_expert_info(undescribed)
      end
    end
    at = at + length
    names[#names + 1] = name
  until at >= stop
  pinfo.cols.protocol = "desim"
  pinfo.cols.info = about.kind .. ": " .. table.concat(names, ", ")
  return stop
end

-- Behind the headers of a technology.
function desim.dissector(buffer, pinfo, tree)
  return messages(buffer, 0, pinfo, tree)
end

-- Behind desim's own header.
local own = Proto("desim_frame", "desim frame")
function own.dissector(buffer, pinfo, tree)
  local item = tree:add(own, buffer(0, 12))
  item:add(f.sender, buffer(0, 4))
  item:add(f.to, buffer(4, 4))
  item:add(f.number, buffer(8, 4))
  local to = buffer(4, 4):uint()
  pinfo.cols.src = "robot " .. buffer(0, 4):uint()
  pinfo.cols.dst = to == EVERYBODY and "everybody" or ("robot " .. to)
  return messages(buffer, 12, pinfo, tree)
end

-- What became of a copy.
local fates = { [0] = "delivered", [1] = "lost", [2] = "in flight", [3] = "strayed" }
local addresses = { [0] = "everyone", [1] = "me", [2] = "another" }
local c = {
  sender = ProtoField.uint32("desim_fate.sender", "Sender", base.DEC),
  receiver = ProtoField.uint32("desim_fate.receiver", "Receiver", base.DEC),
  frame = ProtoField.uint32("desim_fate.frame", "Number of the frame", base.DEC),
  message = ProtoField.uint32("desim_fate.message", "Number of the message", base.DEC),
  topic = ProtoField.string("desim_fate.topic", "Topic"),
  fate = ProtoField.uint8("desim_fate.fate", "Fate", base.DEC, fates),
  cause = ProtoField.uint8("desim_fate.cause", "Cause", base.DEC, causes),
  address = ProtoField.uint8("desim_fate.address", "For whom, as the receiver sees it", base.DEC, addresses),
  power = ProtoField.float("desim_fate.power", "Power (dBm)"),
  distance = ProtoField.float("desim_fate.distance", "Distance (m)"),
  latency = ProtoField.uint64("desim_fate.latency", "Latency (ns)", base.DEC),
}
local listed = {}
for _, field in pairs(c) do listed[#listed + 1] = field end
fate.fields = listed

function fate.dissector(buffer, pinfo, tree)
  local about = interface()
  local name = about.topics[buffer(16, 1):uint()] or "unknown"
  local became = fates[buffer(17, 1):uint()] or "unknown"
  local item = tree:add(fate, buffer())
  item:add(c.sender, buffer(0, 4))
  item:add(c.receiver, buffer(4, 4))
  item:add(c.frame, buffer(8, 4))
  item:add(c.message, buffer(12, 4))
  item:add(c.topic, buffer(16, 1), name)
  item:add(c.fate, buffer(17, 1))
  if buffer(18, 1):uint() ~= 255 then item:add(c.cause, buffer(18, 1)) end
  item:add(c.address, buffer(19, 1))
  local power, distance = buffer(20, 4):float(), buffer(24, 4):float()
  if power == power then item:add(c.power, buffer(20, 4)) end
  if distance == distance then item:add(c.distance, buffer(24, 4)) end
  item:add(c.latency, buffer(28, 8))
  pinfo.cols.protocol = "desim fate"
  pinfo.cols.src = "robot " .. buffer(0, 4):uint()
  pinfo.cols.dst = "robot " .. buffer(4, 4):uint()
  local why = became == "lost" and (": " .. (causes[buffer(18, 1):uint()] or "unknown")) or ""
  pinfo.cols.info = name .. " " .. became .. why
  return buffer:len()
end

-- Over IEEE 802.15.4 by the PAN, which comes before Wireshark guesses; over Wi-Fi by the type; else by the link types for users.
DissectorTable.get("wpan.panid"):add({{pan}}, desim)
DissectorTable.get("ethertype"):add({{ether_type}}, desim)
DissectorTable.get("wtap_encap"):add(wtap.USER0, own)
DissectorTable.get("wtap_encap"):add(wtap.USER1, fate)
