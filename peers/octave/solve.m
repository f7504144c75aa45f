% GNU Octave on the equations of a case, dense, the way Hirai's own scripts work: state
% [u; v] of the free components, forces in vectorised code, M factorized once.
%
% Arguments as src/external.rs says. ode45 and ode15s have their defaults but for the tolerances;
% ode15s makes its Jacobian by differences.

1;

function f = cell_forces (data, u, v)
  % internal forces of all nodes, as a column of components
  U = reshape (u, 2, []); V = reshape (v, 2, []);
  h = cell (2, 2); r = cell (2, 2);
  for i = 1:2
    for j = 1:2
      h{i, j} = zeros (1, rows (data.cells)); r{i, j} = h{i, j};
      for a = 1:3
        h{i, j} += U(i, data.cells(:, a)) .* data.g{a, j};
        r{i, j} += V(i, data.cells(:, a)) .* data.g{a, j};
      endfor
    endfor
  endfor
  if (data.is_green)
    F = {1 + h{1, 1}, h{1, 2}; h{2, 1}, 1 + h{2, 2}};
  else
    F = {1, 0; 0, 1};
  endif
  green = data.is_green;
  e = @(i, j) 0.5 * (h{i, j} + h{j, i} + green * (h{1, i} .* h{1, j} + h{2, i} .* h{2, j}));
  d = @(i, j) 0.5 * (F{1, i} .* r{1, j} + F{2, i} .* r{2, j} + F{1, j} .* r{1, i} + F{2, j} .* r{2, i});
  exx = e (1, 1); eyy = e (2, 2); exy = e (1, 2);
  trace = data.lambda * (exx + eyy);
  sxx = trace + 2 * data.mu * exx; syy = trace + 2 * data.mu * eyy; sxy = 2 * data.mu * exy;
  if (data.mu_vis > 0)
    dxx = d (1, 1); dyy = d (2, 2); dxy = d (1, 2);
    trace = data.lambda_vis * (dxx + dyy);
    sxx += trace + 2 * data.mu_vis * dxx; syy += trace + 2 * data.mu_vis * dyy;
    sxy += 2 * data.mu_vis * dxy;
  endif
  P = {F{1, 1} .* sxx + F{1, 2} .* sxy, F{1, 1} .* sxy + F{1, 2} .* syy;
       F{2, 1} .* sxx + F{2, 2} .* sxy, F{2, 1} .* sxy + F{2, 2} .* syy};
  at = []; values = [];
  for i = 1:2
    for a = 1:3
      at = [at; 2 * (data.cells(:, a) - 1) + i];
      values = [values; -(data.w .* (P{i, 1} .* data.g{a, 1} + P{i, 2} .* data.g{a, 2}))'];
    endfor
  endfor
  f = accumarray (at, values, [numel(u), 1]);
endfunction

function [u, v, a] = held_motion (stage, alpha, t)
  % what prescribed components do: see src/stage.rs
  s = t - stage.start; decay = exp (-alpha * s);
  u = stage.base + stage.path * s + stage.slope * s * decay;
  v = stage.path + stage.slope * (1 - alpha * s) * decay;
  a = stage.slope * alpha * (alpha * s - 2) * decay;
endfunction

function [u, v, a] = complete (data, stage, t, y)
  n = numel (stage.free);
  u = v = zeros (data.dofs, 1);
  u(stage.free) = y(1:n); v(stage.free) = y(n+1:end);
  [u(stage.held), v(stage.held), a] = held_motion (stage, data.alpha, t);
endfunction

function rate = rhs (data, stage, t, y)
  [u, v, a] = complete (data, stage, t, y);
  f = cell_forces (data, u, v) + data.weight;
  if (stage.floor > 0)
    at = 2 * data.boundary;
    height = data.position(data.boundary, 2) + u(at);
    f(at) -= stage.floor * min (height, 0);
  endif
  f = f(stage.free) - stage.border * a;
  rate = [y(numel (stage.free)+1:end); stage.R \ (stage.R' \ f)];
endfunction

function [samples, evaluations] = solve (data, method, rtol, times)
  u = v = zeros (data.dofs, 1); start = 0;
  samples = zeros (data.dofs, numel (times)); taken = 0; evaluations = 0;
  for p = 1:rows (data.phases)
    stop = data.phases(p, 1);
    own = data.held(data.held(:, 1) == p, :);
    stage.start = start; stage.floor = data.phases(p, 2);
    stage.held = own(:, 2); stage.path = own(:, 3);
    stage.base = u(stage.held); stage.slope = v(stage.held) - stage.path;
    stage.free = setdiff ((1:data.dofs)', stage.held);
    stage.R = chol (data.M(stage.free, stage.free));
    stage.border = data.M(stage.free, stage.held);
    atol = [data.atol(1) * ones(numel (stage.free), 1); data.atol(2) * ones(numel (stage.free), 1)];
    options = odeset ("RelTol", rtol, "AbsTol", rtol * atol);
    inside = times(times > start & times < stop)';
    grid = [start, inside, stop];
    if (numel (grid) == 2)
      grid = [start, 0.5 * (start + stop), stop];
    endif
    y = [u(stage.free); v(stage.free)];
    [t, y] = feval (method, @(t, y) rhs (data, stage, t, y), grid, y, options);
    if (t(end) < stop)
      error ("it stops at t = %g s", t(end));
    endif
    for k = 1:numel (inside)
      taken += 1;
      samples(:, taken) = complete (data, stage, grid(k + 1), y(k + 1, :)');
    endfor
    [u, v] = complete (data, stage, stop, y(end, :)');
    if (taken < numel (times) && times(taken + 1) <= stop)
      taken += 1;
      samples(:, taken) = u;
    endif
    start = stop;
  endfor
endfunction

function data = read_case (folder)
  read = @(name) load ("-ascii", [folder "/" name]);
  data.position = read ("nodes"); data.cells = read ("cells"); data.phases = read ("phases");
  data.boundary = read ("boundary");
  data.held = read ("held");
  if (isempty (data.held))
    data.held = zeros (0, 3);
  endif
  numbers = read ("numbers");
  data.lambda = numbers(1); data.mu = numbers(2);
  data.lambda_vis = numbers(3); data.mu_vis = numbers(4);
  thickness = numbers(5); data.is_green = numbers(8); data.alpha = numbers(9);
  data.atol = numbers(10:11);
  data.dofs = 2 * rows (data.position);
  masses = read ("masses");
  m = sparse (masses(:, 1), masses(:, 2), masses(:, 3));
  data.M = full (kron (m, speye (2)));
  data.weight = data.M * repmat (numbers(6:7)', rows (data.position), 1);
  x = reshape (data.position(data.cells, 1), [], 3); y = reshape (data.position(data.cells, 2), [], 3);
  twice = (x(:, 2) - x(:, 1)) .* (y(:, 3) - y(:, 1)) - (x(:, 3) - x(:, 1)) .* (y(:, 2) - y(:, 1));
  for a = 1:3
    b = mod (a, 3) + 1; c = mod (a + 1, 3) + 1;
    data.g{a, 1} = ((y(:, b) - y(:, c)) ./ twice)'; data.g{a, 2} = ((x(:, c) - x(:, b)) ./ twice)';
  endfor
  data.w = (0.5 * twice * thickness)';
endfunction

warning ("off", "all");
[method, setting, folder, times, out] = deal (argv (){end-4:end});
try
  data = read_case (folder);
  times = load ("-ascii", times);
  clock = cputime ();
  samples = solve (data, method, str2double (setting), times);
  seconds = cputime () - clock;
  file = fopen (out, "wb");
  fwrite (file, samples, "double");
  fclose (file);
  printf ("%.6f -1 -1 -1\n", seconds);
catch
  printf ("failed: %s\n", strrep (lasterr (), "\n", " "));
end_try_catch
