-- Opens the file SCENE in Neovim with the language server JABUKA, takes the first action at the first problem, and writes into the file REPORT, as JSON,
-- the problems before and after, the action, and what the server says of the key at the beginning of the last line. Then it saves the scene.

local function waits_for(is)
  assert(vim.wait(60000, is, 20), "in vain")
end

local function ask(method, parameters)
  for _, answer in pairs(vim.lsp.buf_request_sync(0, method, parameters, 60000) or {}) do
    return answer.result
  end
end

local function problems()
  return vim.tbl_map(function(it) return { line = it.lnum, column = it.col, code = it.code } end, vim.diagnostic.get(0))
end

local function mend()
  vim.cmd("edit " .. vim.env.SCENE)
  local settings = { name = "jabuka", cmd = { vim.env.JABUKA, "lsp" }, root_dir = vim.fn.getcwd() }
  if vim.lsp.start then
    vim.lsp.start(settings)
  else
    vim.lsp.buf_attach_client(0, vim.lsp.start_client(settings))
  end
  waits_for(function() return #vim.diagnostic.get(0) > 0 end)
  local report = { before = problems() }
  local first = vim.diagnostic.get(0)[1]
  vim.api.nvim_win_set_cursor(0, { first.lnum + 1, first.col })
  local range = vim.lsp.util.make_range_params(0, "utf-16")
  range.context = { diagnostics = {} }
  local action = ask("textDocument/codeAction", range)[1]
  vim.lsp.util.apply_workspace_edit(action.edit, "utf-16")
  waits_for(function() return #vim.diagnostic.get(0) == 0 end)
  vim.api.nvim_win_set_cursor(0, { vim.api.nvim_buf_line_count(0), 0 })
  local hover = ask("textDocument/hover", vim.lsp.util.make_position_params(0, "utf-16"))
  report.after, report.action, report.hover = #vim.diagnostic.get(0), action.title, hover.contents.value
  vim.cmd("write")
  vim.fn.writefile({ vim.json.encode(report) }, vim.env.REPORT)
end

local is_done, why = pcall(mend)
if not is_done then
  io.stderr:write(tostring(why), "\n")
  vim.cmd("cquit")
end
vim.cmd("qall!")
