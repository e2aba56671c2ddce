/* Made by crates/pipeline/web/build.mjs; do not edit. Sources 419a41102ee937be. With three 0.170.0 and uPlot 1.6.31 (MIT), see LICENCES.txt. */
(()=>{function q(i,t={},...e){let n=document.createElement(i);for(let[s,r]of Object.entries(t))s.startsWith("on")?n.addEventListener(s.slice(2),r):r===!0?n.setAttribute(s,""):r!==!1&&r!==null&&r!==void 0&&n.setAttribute(s,r);return n.append(...e.flat().filter(s=>s!=null)),n}var Dn=i=>getComputedStyle(document.documentElement).getPropertyValue(`--${i}`).trim();function Rs(i,t,e){let n=q("input",{type:"checkbox",checked:t,onchange:()=>e(n.checked)});return q("label",{},n,i)}var $e=(i,t)=>i==null||Number.isNaN(i)?"":i.toFixed(t);var hn=(i,t)=>i.map((e,n)=>e+t[n]),Hn=(i,t)=>i.map((e,n)=>e-t[n]),Ve=(i,t)=>i.map(e=>e*t),lg=(i,t)=>i.reduce((e,n,s)=>e+n*t[s],0),na=(i,t)=>[i[1]*t[2]-i[2]*t[1],i[2]*t[0]-i[0]*t[2],i[0]*t[1]-i[1]*t[0]],ai=i=>Math.hypot(...i),Gn=i=>Ve(i,1/(ai(i)||1)),wn=(i,t)=>i.map(e=>lg(e,t));function Vl([i,t,e,n],[s,r,o,a]){return[i*s-t*r-e*o-n*a,i*r+t*s+e*a-n*o,i*o-t*a+e*s+n*r,i*a+t*o-e*r+n*s]}function cg(i){let t=ai(i),e=t>1e-12?Math.sin(t/2)/t:.5;return[Math.cos(t/2),...Ve(i,e)]}function sf(i){let[t,...e]=i[0]<0?Ve(i,-1):i,n=ai(e);return n<1e-12?Ve(e,2):Ve(e,2*Math.atan2(n,t)/n)}var rf=([i,t,e,n])=>[i,-t,-e,-n];function go([i,t,e,n]){return[[1-2*(e*e+n*n),2*(t*e-i*n),2*(t*n+i*e)],[2*(t*e+i*n),1-2*(t*t+n*n),2*(e*n-i*t)],[2*(t*n-i*e),2*(e*n+i*t),1-2*(t*t+e*e)]]}function as(i,t){let e=i.slice(3);return{q:e,at:hn(i.slice(0,3),wn(go(e),t))}}function ia({q:i,at:t},e){let n=ai(i)*(i[0]<0?-1:1),s=Ve(i,1/n);return[...Hn(t,wn(go(s),e)),...s]}function _o({q:i,at:t},e,n){if(!ai(n))return{q:i,at:hn(t,e)};let s=Vl(cg(n),i);return{q:Ve(s,1/ai(s)),at:hn(t,e)}}function xo(i,t){let e=wn(i.matrix,Hn(t,i.source));return[e[0]/e[2],e[1]/e[2],e[2]]}var Hl=(i,[t,e],n)=>hn(i.source,wn(i.inverse,[t*n,e*n,n]));function ea(i,t,e){let n=i.recorded;if(!n)return[t,e];let s=n.count-1,[r,o]=[(t-n.first[0])/n.step[0],(e-n.first[1])/n.step[1]],[a,l]=[r,o].map(p=>Math.max(0,Math.min(s-1,Math.floor(p)))),c=(p,_)=>n.px[(l+_)*n.count+a+p],u=[c(0,0),c(1,0),c(0,1),c(1,1)];if(u.some(p=>!p))return[t,e];let[f,h]=[r-a,o-l];return[0,1].map(p=>(1-h)*((1-f)*u[0][p]+f*u[1][p])+h*((1-f)*u[2][p]+f*u[3][p]))}var hg=320;function sa(i,t,e){let n=go(t.q),s=i.xyz.length/3,r=new Float64Array(2*s),[o,a,l,c]=[1/0,1/0,-1/0,-1/0];for(let S=0;S<s;S++){let v=[i.xyz[3*S],i.xyz[3*S+1],i.xyz[3*S+2]],[y,I,C]=xo(e,hn(t.at,wn(n,v)));if(!(C>0))return[];r[2*S]=y,r[2*S+1]=I,o=Math.min(o,y),l=Math.max(l,y),a=Math.min(a,I),c=Math.max(c,I)}let u=Math.max(l-o,c-a,1e-6)/hg,f=Math.ceil((l-o)/u)+5,h=Math.ceil((c-a)/u)+5,p=(S,v)=>[(S-o)/u+2,(v-a)/u+2],_=new Uint8Array(f*h),g=i.triangles,m=new Uint8Array(g.length/3);for(let S=0;S<m.length;S++){let[v,y,I]=[g[3*S],g[3*S+1],g[3*S+2]],C=(r[2*y]-r[2*v])*(r[2*I+1]-r[2*v+1])-(r[2*I]-r[2*v])*(r[2*y+1]-r[2*v+1]);m[S]=C>0?1:0,ug(_,f,h,[v,y,I].map(R=>p(r[2*R],r[2*R+1])))}let d=[];for(let{a:S,b:v,faces:y}of i.edges){if(y.length===2&&m[y[0]]===m[y[1]])continue;let[I,C,R,L]=[r[2*S],r[2*S+1],r[2*v],r[2*v+1]],E=Math.hypot(R-I,L-C);if(E<1e-9)continue;let[b,A]=[(L-C)/E,(I-R)/E],O=[0,1,2].map(Z=>g[3*y[0]+Z]).find(Z=>Z!==S&&Z!==v);(r[2*O]-I)*b+(r[2*O+1]-C)*A>0&&(b=-b,A=-A);let[F,G]=p((I+R)/2+1.5*u*b,(C+L)/2+1.5*u*A);if(_[Math.round(G)*f+Math.round(F)])continue;let[$,W]=[ea(e,I,C),ea(e,R,L)];d.push({ax:$[0],ay:$[1],bx:W[0],by:W[1],nx:b,ny:A})}return d}function ug(i,t,e,[[n,s],[r,o],[a,l]]){let c=(r-n)*(l-s)-(a-n)*(o-s);if(!c)return;let u=Math.sign(c),f=(m,d,S)=>Math.max(0,Math.ceil(Math.min(m,d,S))),[h,p]=[f(s,o,l),Math.min(e-1,Math.floor(Math.max(s,o,l)))],[_,g]=[f(n,r,a),Math.min(t-1,Math.floor(Math.max(n,r,a)))];for(let m=h;m<=p;m++)for(let d=_;d<=g;d++)u*((r-n)*(m-s)-(d-n)*(o-s))>=0&&u*((a-r)*(m-o)-(d-r)*(l-o))>=0&&u*((n-a)*(m-l)-(d-a)*(s-l))>=0&&(i[m*t+d]=1)}var mo=16,fg=.7;function of(i,t){let e=new Map;for(let{xy:n,closed:s,bodies:r}of i){if(r&&!r.includes(t))continue;let o=n.length/2;for(let a=0;a<o;a++){let[l,c]=[a>0?a-1:s?o-1:0,a+1<o?a+1:s?0:o-1],[u,f]=[n[2*c]-n[2*l],n[2*c+1]-n[2*l+1]],h=Math.hypot(u,f)||1,p={x:n[2*a],y:n[2*a+1],dx:f/h,dy:-u/h},_=`${Math.floor(p.x/mo)},${Math.floor(p.y/mo)}`;e.has(_)?e.get(_).push(p):e.set(_,[p])}}return e}function af(i,t,{size:e,inset:n,bright:s}){let[r,o,a]=[0,0,0];return{residuals:i.map(({ax:c,ay:u,bx:f,by:h,nx:p,ny:_})=>{let[g,m,d]=[(c+f)/2,(u+h)/2,Math.hypot(f-c,h-u)];if(g<0||m<0||g>e[0]-1||m>e[1]-1)return NaN;a+=d;let[S,v]=[mo**2,NaN],[y,I]=[Math.floor(g/mo),Math.floor(m/mo)];for(let C=I-1;C<=I+1;C++)for(let R=y-1;R<=y+1;R++)for(let L of t.get(`${R},${C}`)??[]){let E=(L.x-g)**2+(L.y-m)**2;E>=S||(L.dx*p+L.dy*_)*(s?-1:1)<fg||(S=E,v=((L.x-g)*L.dx+(L.y-m)*L.dy)/(L.dx*p+L.dy*_)+n)}return Number.isNaN(v)||(r+=v*v*d,o+=d),v}),rms:Math.sqrt(r/o),share:a?o/a:NaN}}function pr(i){let t=atob(i),e=new Uint8Array(t.length);for(let n=0;n<t.length;n++)e[n]=t.charCodeAt(n);return e}var dg=1024,lf=8,Gl=i=>i/lf-dg;function cf({place:i,inset_px:t,samples:e,residuals:n}){let s=new Uint16Array(pr(e).buffer),r=new Int16Array(pr(n).buffer),o=Array.from(r,(a,l)=>{let c=s[4*l+2]/65536*2*Math.PI;return{x:Gl(s[4*l]),y:Gl(s[4*l+1]),nx:Math.cos(c),ny:Math.sin(c),length:s[4*l+3]/lf,residual:a===-32768?NaN:a/100}});return{place:i,inset:t,points:o}}function hf({counts:i,points:t,bodies:e}){let n=new Uint16Array(pr(t).buffer),s=0;return i.map((r,o)=>{let a=Math.abs(r),l=new Float32Array(2*a);for(let c=0;c<2*a;c++)l[c]=Gl(n[s+c]);return s+=2*a,{xy:l,closed:r<0,bodies:e[o]??null}})}function uf({vertices:i,triangles:t,middle:e},n){let s=new Float32Array(pr(i).buffer),r=new Uint32Array(pr(t).buffer),o=n??e,a=new Float64Array(s.length),l=0;for(let f=0;f<s.length;f++)a[f]=s[f]+e[f%3]-o[f%3];for(let f=0;f<s.length;f+=3)l+=Math.hypot(a[f],a[f+1],a[f+2])*3/s.length;let c=new Map,u=[];for(let f=0;f<r.length/3;f++)for(let h=0;h<3;h++){let[p,_]=[r[3*f+h],r[3*f+(h+1)%3]],g=Math.min(p,_)*(s.length/3)+Math.max(p,_),m=c.get(g);if(m)m.faces.push(f);else{let d={a:p,b:_,faces:[f]};c.set(g,d),u.push(d)}}return{xyz:a,triangles:r,edges:u,centroid:o,radius:l}}var gt=JSON.parse(document.getElementById("data").textContent);gt.views.forEach(i=>{i.inverse=pg(i.matrix)});var Ai={g:"good",d:"doubtful",a:"ambiguous",f:"failed"};function pg(i){let[[t,e,n],[s,r,o],[a,l,c]]=i,u=t*(r*c-o*l)-e*(s*c-o*a)+n*(s*l-r*a);return[[r*c-o*l,n*l-e*c,e*o-n*r],[o*a-s*c,t*c-n*a,n*s-t*o],[s*l-r*a,e*a-t*l,t*r-e*s]].map(f=>f.map(h=>h/u))}var Wl=new Map([...document.querySelectorAll("script[data-src]")].map(i=>[i.dataset.src,i])),pf=Wl.size>0,ra=new Map;for(let i of["biplaneFrame","biplaneModels"])window[i]=t=>ra.get(document.currentScript)?.(t);function mf(i){let t=Wl.get(i);if(t){let e=t.textContent;return Promise.resolve(JSON.parse(e.slice(e.indexOf("(")+1,e.lastIndexOf(")"))))}return pf?Promise.reject(new Error("This frame is not in this file: it holds some frames alone.")):new Promise((e,n)=>{let s=document.createElement("script"),r=()=>{ra.delete(s),s.remove()};ra.set(s,o=>{r(),e(o)}),s.onerror=()=>{r(),n(new Error(`${i} cannot be read: is the folder report/ beside the page?`))},s.onload=()=>{ra.has(s)&&(r(),n(new Error(`${i} is not as the page expects it; run again`)))},s.src=i,document.head.append(s)})}var mg=48,Ps=new Map;function ls(i,t){let e=gt.trials[i].scripts[t];if(!e)return Promise.reject(new Error("None of the pictures of this frame could be used; the overview says why."));let n=Ps.get(e);for(n?Ps.delete(e):n=mf(e).then(gg),Ps.set(e,n),n.catch(()=>Ps.delete(e));Ps.size>mg;)Ps.delete(Ps.keys().next().value);return n}function Xl(i,t){let e=gt.trials[i].scripts[t];return!!e&&(!pf||Wl.has(e))}async function gg(i){return{views:await Promise.all(i.views.map(async e=>{let n=await new Promise((s,r)=>{let o=new Image;o.onload=()=>s(o),o.onerror=()=>r(new Error("A picture of this frame is damaged; run again.")),o.src=e.picture});return{slot:e.slot,size:e.size,image:n,edges:hf(e.edges),outlines:e.outlines.map(cf)}}))}}var ff=null;function mr(){return ff??=mf("report/models.js").then(i=>new Map(i.map(t=>[t.body,uf(t,gt.bodies[t.body].centroid)]))),ff}var ql=new Set,Ft={trial:0,frame:0,playing:!1};function Ci(i){ql.add(i)}function li(i,t){let e=gt.trials[i].frames.length,n=Math.max(0,Math.min(e-1,t));Ft.trial===i&&Ft.frame===n||(Object.assign(Ft,{trial:i,frame:n}),ql.forEach(s=>s()))}var df=0;function Is(i,t=()=>!0){Ft.playing=i,clearInterval(df);let e=gt.trials[Ft.trial],n=e.times.length>1?(e.times.at(-1)-e.times[0])/(e.times.length-1)*1e3:120;i&&(df=setInterval(()=>{t()&&li(Ft.trial,(Ft.frame+1)%gt.trials[Ft.trial].frames.length)},Math.max(33,Math.min(400,n)))),ql.forEach(s=>s())}var oa=(i,t,e)=>gt.trials[i].rows[t].verdicts[e];function gf(i,t){let e=gt.trials[i].rows.map(n=>"gdaf".indexOf(n.verdicts[t]));return"gdaf"[Math.max(0,...e)]}var $l={g:.3,d:.6,a:.8,f:1};function gr(i,t){li(i,t),location.hash=`frame/${encodeURIComponent(gt.trials[i].name)}/${encodeURIComponent(gt.trials[i].frames[t])}`}function _g(i,t,e){let{rows:n,frames:s}=gt.trials[i],r=q("canvas",{tabindex:0,role:"img","aria-label":_f(n[t].verdicts)}),o=l=>Math.max(0,Math.min(s.length-1,Math.floor(l.offsetX/r.clientWidth*s.length)));r.addEventListener("click",l=>e(i,o(l))),r.addEventListener("mousemove",l=>{let c=o(l);r.title=`${s[c]}: ${Ai[n[t].verdicts[c]]}${n[t].reasons[c]?` (${n[t].reasons[c]})`:""}`});let a=()=>{let l=window.devicePixelRatio||1,[c,u]=[r.clientWidth*l,r.clientHeight*l];if(!c)return;Object.assign(r,{width:c,height:u});let f=r.getContext("2d");f.fillStyle=Dn("line"),f.fillRect(0,0,c,u);let h=c/s.length,p=h>5*l?l:0;for(let _ of"gdaf"){f.fillStyle=Dn(`${Ai[_]}-mark`);for(let g=0;g<s.length;g++)n[t].verdicts[g]===_&&f.fillRect(g*h,u*(1-$l[_]),Math.max(h-p,l),u*$l[_])}if(h>12*l){f.fillStyle=Dn("ink"),f.font=`${10*l}px system-ui`,f.textAlign="center";for(let _=0;_<s.length;_++)n[t].verdicts[_]!=="g"&&f.fillText(n[t].verdicts[_].toUpperCase(),(_+.5)*h,u-3*l)}f.fillStyle=Dn("focus");for(let _ of n[t].edited)f.fillRect(_*h,0,Math.max(h-p,2*l),3*l);Ft.trial===i&&(f.strokeStyle=Dn("ink"),f.lineWidth=2*l,f.strokeRect(Ft.frame*h+1,1,Math.max(h-p,3*l)-2+(h<4?3:0),u-2))};return new ResizeObserver(a).observe(r),Ci(a),r}function _f(i){return Object.entries(Ai).map(([t,e])=>`${[...i].filter(n=>n===t).length} ${e}`).join(", ")}function xg(i,t){let e=gt.trials[i];return q("span",{class:"name"},q("i",{class:"c",style:`background:${e.colours[t]}`}),gt.bodies[e.bodies[t]].name)}function Zl(i,t){return gt.trials[i].bodies.map((e,n)=>q("div",{class:"strip"},xg(i,n),_g(i,n,t),q("span",{class:"soft"},_f(gt.trials[i].rows[n].verdicts).replace(/(^|, )0 \w+/g,"").replace(/^, /,""))))}function Jl(){let i=t=>q("span",{},q("i",{style:`background:var(--${Ai[t]}-mark);height:${11*$l[t]}px`}),Ai[t]);return q("div",{class:"legend"},..."gdaf".split("").map(i),q("span",{},q("i",{style:"background:var(--focus);height:3px"}),"edited by hand"),"click: go to the frame")}function Kl(){let i=[];return gt.trials.forEach((t,e)=>t.rows.forEach((n,s)=>{for(let r=0;r<t.frames.length;r++){let o=1e3*"gdaf".indexOf(n.verdicts[r])+(n.look[r]&&!n.edited.includes(r)?500:0),a=Math.max(0,...n.rms_px[r]??[9]);i.push({trial:e,place:s,frame:r,badness:o+Math.min(99,a)})}})),i.sort((t,e)=>e.badness-t.badness||t.trial-e.trial||t.frame-e.frame)}var Yl=12,yo=200;function xf(){let i=document.getElementById("strips");gt.trials.forEach((e,n)=>i.append(q("div",{class:"panel"},q("h3",{},e.name," ",q("small",{class:"soft"},`${e.frames.length} frames`)),Zl(n,gr),n===gt.trials.length-1?Jl():null)));let t=Kl().filter(e=>e.badness>=500);if(t.length){let e=({trial:r,place:o,frame:a})=>{let{name:l,frames:c,rows:u,bodies:f}=gt.trials[r],h=u[o];return q("tr",{},q("td",{class:"t"},yf(r,a,`${l} · ${c[a]}`)),q("td",{class:"t"},gt.bodies[f[o]].name),q("td",{class:"t"},Ls(h.verdicts[a])),q("td",{class:"reason"},[h.reasons[a],h.look[a]].filter(Boolean).join("; ")))},n=q("tbody",{},t.slice(0,Yl).map(e)),s=t.length>Yl?q("button",{type:"button",onclick:r=>{n.append(...t.slice(Yl,500).map(e)),r.target.remove()}},`all ${t.length}`):null;document.getElementById("first").append(q("h2",{},`Look at these first (${t.length})`),q("div",{class:"table"},q("table",{},n)),q("p",{},s," ",q("a",{href:"#review"},"put poses right in the review")))}yg(document.getElementById("table"))}var yf=(i,t,e)=>q("a",{href:`#frame/${encodeURIComponent(gt.trials[i].name)}/${encodeURIComponent(gt.trials[i].frames[t])}`},e),Ls=i=>q("span",{class:`v ${Ai[i]}`},Ai[i]);function yg(i){let t=[];gt.trials.forEach((c,u)=>c.frames.forEach((f,h)=>c.rows.forEach((p,_)=>t.push([u,h,_]))));let[e,n]=[!1,0],s=q("tbody"),r=q("span",{class:"soft"}),o=()=>{let c=e?t.filter(([f,h,p])=>gt.trials[f].rows[p].verdicts[h]!=="g"):t,u=Math.max(1,Math.ceil(c.length/yo));n=Math.max(0,Math.min(u-1,n)),r.textContent=`${c.length?n*yo+1:0} to ${Math.min(c.length,(n+1)*yo)} of ${c.length}`,s.replaceChildren(...c.slice(n*yo,(n+1)*yo).map(([f,h,p])=>{let{name:_,frames:g,times:m,bodies:d,rows:S}=gt.trials[f],v=S[p],y=v.half_95[h],I=(C,R,L)=>(C??[]).map(E=>$e(E*R,L)).join(" / ");return q("tr",{},q("td",{class:"t"},yf(f,h,`${gt.trials.length>1?`${_} · `:""}${g[h]}`)),q("td",{},$e(m[h],3)),q("td",{class:"t"},gt.bodies[d[p]].name),q("td",{class:"t"},Ls(v.verdicts[h])),q("td",{},$e(v.fit_mm[h],3)),q("td",{},I(v.rms_px[h],1,2)),q("td",{},I(v.share[h],100,0)),q("td",{},y?y.slice(0,3).map(C=>$e(C,2)).join(" / "):""),q("td",{},y?y.slice(3).map(C=>$e(C,2)).join(" / "):""),q("td",{class:"reason"},[v.reasons[h],v.look[h]].filter(Boolean).join("; ")))}))},a=c=>()=>{n+=c,o()},l=["frame","time s","body","verdict","fit mm","fit px, by view","found %, by view","95 % ± mm x / y / z","95 % ± ° x / y / z","why"];i.append(q("h2",{},"All poses"),q("div",{class:"bar"},vg("only what is not good",c=>{e=c,n=0,o()}),q("button",{type:"button",onclick:a(-1)},"‹"),r,q("button",{type:"button",onclick:a(1)},"›")),q("div",{class:"table"},q("table",{},q("thead",{},q("tr",{},l.map((c,u)=>q("th",{class:[0,2,3,9].includes(u)?"t":null},c)))),s))),o()}var vg=(i,t)=>{let e=q("input",{type:"checkbox",onchange:()=>t(e.checked)});return q("label",{},e,i)};var Mf="#9aa0a6";function Sf(i){if(Number.isNaN(i))return Mf;let t=Math.min(1,Math.abs(i)/1.5),e=[[0,[64,190,160]],[.33,[240,220,80]],[1,[240,60,60]]],n=t<.33?0:1,s=(t-e[n][0])/(e[n+1][0]-e[n][0]);return`rgb(${e[n][1].map((r,o)=>Math.round(r+s*(e[n+1][1][o]-r))).join(",")})`}var vf=12,cs=class i{constructor(t){this.host=t,t.classList.add("view"),t.innerHTML='<canvas tabindex="0"></canvas><div class="tag"></div><div class="tools"><button type="button" title="Whole picture (double click)">fit</button></div>',this.canvas=t.querySelector("canvas"),this.tag=t.querySelector(".tag"),this.view=null,this.scale=0,this.offset=[0,0],this.overlay=null,this.drag=null,this.grab=null,t.querySelector("button").addEventListener("click",()=>this.fit()),this.canvas.addEventListener("dblclick",()=>this.fit()),this.canvas.addEventListener("wheel",e=>this.wheel(e),{passive:!1}),this.canvas.addEventListener("contextmenu",e=>e.preventDefault()),this.canvas.addEventListener("pointerdown",e=>this.down(e)),this.canvas.addEventListener("pointermove",e=>this.move(e));for(let e of["pointerup","pointercancel"])this.canvas.addEventListener(e,()=>this.up());new ResizeObserver(()=>{this.resize()&&this.draw()}).observe(t)}resize(){let{clientWidth:t,clientHeight:e}=this.host;if(!t||!e)return!1;let n=window.devicePixelRatio||1,s=!this.scale||this.fitted;return this.canvas.width=Math.round(t*n),this.canvas.height=Math.round(e*n),this.ratio=n,s&&this.view&&this.whole(),!0}whole(){let[t,e]=this.view.size;this.scale=Math.min(this.canvas.width/t,this.canvas.height/e)*.98,this.offset=[(this.canvas.width-t*this.scale)/2,(this.canvas.height-e*this.scale)/2],this.fitted=!0}fit(){this.view&&(this.whole(),this.draw())}pixel(t,e){return[t,e].map((n,s)=>(n*this.ratio-this.offset[s])/this.scale-.5)}wheel(t){if(t.preventDefault(),this.turnWheel?.(t))return;let e=Math.exp(-t.deltaY*.0015),n=[t.offsetX*this.ratio,t.offsetY*this.ratio],s=Math.max(.05,Math.min(64,this.scale*e));this.offset=this.offset.map((r,o)=>n[o]-(n[o]-r)*s/this.scale),this.scale=s,this.fitted=!1,this.draw()}down(t){this.canvas.focus({preventScroll:!0});try{this.canvas.setPointerCapture(t.pointerId)}catch{}let e=t.button!==1&&this.grab?.(t);this.drag={x:t.clientX,y:t.clientY,own:e}}move(t){if(!this.drag)return;let e=[t.clientX-this.drag.x,t.clientY-this.drag.y];if(Object.assign(this.drag,{x:t.clientX,y:t.clientY}),this.drag.own){this.drag.own(Mg(e,this.ratio/this.scale),t);return}this.offset=this.offset.map((n,s)=>n+e[s]*this.ratio),this.fitted=!1,this.draw()}up(){let t=this.drag?.own;this.drag=null,t&&this.released?.()}show(t,e){let n=!this.view||String(this.view.size)!==String(t.size);this.view=t,this.overlay=e,n&&(this.scale=0,this.resize()),this.draw()}draw(){if(!this.view||!this.canvas.width||!this.scale)return;let t=this.canvas.getContext("2d");t.setTransform(1,0,0,1,0,0),t.clearRect(0,0,this.canvas.width,this.canvas.height),t.setTransform(this.scale,0,0,this.scale,this.offset[0],this.offset[1]),t.imageSmoothingEnabled=this.scale<3;let e=i.look;t.filter=e.brightness===100&&e.contrast===100?"none":`brightness(${e.brightness}%) contrast(${e.contrast}%)`,t.drawImage(this.view.image,0,0,this.view.size[0],this.view.size[1]),t.filter="none",t.translate(.5,.5),t.lineCap="butt",this.overlay?.(t,this.ratio/this.scale)}};cs.look={brightness:100,contrast:100};var Mg=(i,t)=>i.map(e=>e*t);function aa(i,t,e){i.lineWidth=e,i.strokeStyle="rgba(255,255,120,.55)",i.beginPath();for(let{xy:n,closed:s}of t){i.moveTo(n[0],n[1]);for(let r=2;r<n.length;r+=2)i.lineTo(n[r],n[r+1]);s&&i.closePath()}i.stroke()}function bf(i,t,e,{colour:n,failed:s,residuals:r}){let o=l=>{let c=Math.max(l.length,1.2)/2+.15;i.moveTo(l.x-c*l.ny,l.y+c*l.nx),i.lineTo(l.x+c*l.ny,l.y-c*l.nx)};if(i.lineWidth=1.7*e,!r){i.strokeStyle=n,i.beginPath();for(let l of t)(!s||(l.x+l.y)/9%2<1)&&o(l);i.stroke();return}let a=new Map;t.forEach((l,c)=>{let u=Sf(Number.isNaN(l.residual)?NaN:Math.round(l.residual*10)/10);a.has(u)||a.set(u,[]),a.get(u).push([l,c])});for(let[l,c]of a){i.strokeStyle=l,i.lineWidth=1.9*e,i.beginPath();for(let[u]of c)o(u);if(i.stroke(),l!==Mf){i.lineWidth=e,i.beginPath();for(let[u,f]of c)f%2||(i.moveTo(u.x,u.y),i.lineTo(u.x+u.nx*u.residual*vf,u.y+u.ny*u.residual*vf));i.stroke()}}}function la(i,t,e,n,s){let r=new Map;t.forEach((o,a)=>{let l=s?Sf(Number.isNaN(s[a])?NaN:Math.round(s[a]*10)/10):n;r.has(l)||r.set(l,[]),r.get(l).push(o)}),i.lineWidth=1.8*e;for(let[o,a]of r){i.strokeStyle=o,i.beginPath();for(let{ax:l,ay:c,bx:u,by:f}of a)i.moveTo(l,c),i.lineTo(u,f);i.stroke()}}function wf(i){let t=new Set(i.keys()),e=[],n=0,s=null;for(;t.size;){let[r,o]=[1/0,-1];for(let a of t){let l=s===null?i[a].x+i[a].y:(i[a].x-i[s].x)**2+(i[a].y-i[s].y)**2;l<r&&(r=l,o=a)}if(s!==null){let a=Math.sqrt(r);a>8?(e.push({s:n+1,point:null}),n+=8):n+=a}t.delete(o),s=o,e.push({s:n,point:i[o]})}return e}var Qe="u-",Sg="uplot",bg=Qe+"hz",wg=Qe+"vt",Eg=Qe+"title",Tg=Qe+"wrap",Ag=Qe+"under",Cg=Qe+"over",Rg=Qe+"axis",Ns=Qe+"off",Pg=Qe+"select",Ig=Qe+"cursor-x",Lg=Qe+"cursor-y",Dg=Qe+"cursor-pt",Ug=Qe+"legend",Ng=Qe+"live",Og=Qe+"inline",Fg=Qe+"series",Bg=Qe+"marker",Ef=Qe+"label",kg=Qe+"value",So="width",bo="height",vo="top",Tf="bottom",_r="left",jl="right",pc="#000",Af=pc+"0",Cf="mousemove",Rf="mousedown",Ql="mouseup",Pf="mouseenter",If="mouseleave",Lf="dblclick",zg="resize",Vg="scroll",Df="change",da="dppxchange",mc="--",Er=typeof window<"u",sc=Er?document:null,yr=Er?window:null,Hg=Er?navigator:null,Se,ca;function rc(){let i=devicePixelRatio;Se!=i&&(Se=i,ca&&ac(Df,ca,rc),ca=matchMedia(`(min-resolution: ${Se-.001}dppx) and (max-resolution: ${Se+.001}dppx)`),Os(Df,ca,rc),yr.dispatchEvent(new CustomEvent(da)))}function Wn(i,t){if(t!=null){let e=i.classList;!e.contains(t)&&e.add(t)}}function oc(i,t){let e=i.classList;e.contains(t)&&e.remove(t)}function Oe(i,t,e){i.style[t]=e+"px"}function ci(i,t,e,n){let s=sc.createElement(i);return t!=null&&Wn(s,t),e?.insertBefore(s,n),s}function Qn(i,t){return ci("div",i,t)}var Uf=new WeakMap;function Ri(i,t,e,n,s){let r="translate("+t+"px,"+e+"px)",o=Uf.get(i);r!=o&&(i.style.transform=r,Uf.set(i,r),t<0||e<0||t>n||e>s?Wn(i,Ns):oc(i,Ns))}var Nf=new WeakMap;function Of(i,t,e){let n=t+e,s=Nf.get(i);n!=s&&(Nf.set(i,n),i.style.background=t,i.style.borderColor=e)}var Ff=new WeakMap;function Bf(i,t,e,n){let s=t+""+e,r=Ff.get(i);s!=r&&(Ff.set(i,s),i.style.height=e+"px",i.style.width=t+"px",i.style.marginLeft=n?-t/2+"px":0,i.style.marginTop=n?-e/2+"px":0)}var gc={passive:!0},Gg={...gc,capture:!0};function Os(i,t,e,n){t.addEventListener(i,e,n?Gg:gc)}function ac(i,t,e,n){t.removeEventListener(i,e,gc)}Er&&rc();function hi(i,t,e,n){let s;e=e||0,n=n||t.length-1;let r=n<=2147483647;for(;n-e>1;)s=r?e+n>>1:Xn((e+n)/2),t[s]<i?e=s:n=s;return i-t[e]<=t[n]-i?e:n}function vr(i,t,e,n){for(let s=n==1?t:e;s>=t&&s<=e;s+=n)if(i[s]!=null)return s;return-1}function Wg(i,t,e,n){let s=de,r=-de;if(n==1)s=i[t],r=i[e];else if(n==-1)s=i[e],r=i[t];else for(let o=t;o<=e;o++){let a=i[o];a!=null&&(a<s&&(s=a),a>r&&(r=a))}return[s,r]}function Xg(i,t,e){let n=de,s=-de;for(let r=t;r<=e;r++){let o=i[r];o!=null&&o>0&&(o<n&&(n=o),o>s&&(s=o))}return[n,s]}function ga(i,t,e,n){let s=Vf(i),r=Vf(t);i==t&&(s==-1?(i*=e,t/=e):(i/=e,t*=e));let o=e==10?zi:fd,a=s==1?Xn:ti,l=r==1?ti:Xn,c=a(o(je(i))),u=l(o(je(t))),f=Mr(e,c),h=Mr(e,u);return e==10&&(c<0&&(f=Le(f,-c)),u<0&&(h=Le(h,-u))),n||e==2?(i=f*s,t=h*r):(i=md(i,f),t=_a(t,h)),[i,t]}function _c(i,t,e,n){let s=ga(i,t,e,n);return i==0&&(s[0]=0),t==0&&(s[1]=0),s}var xc=.1,kf={mode:3,pad:xc},Eo={pad:0,soft:null,mode:0},qg={min:Eo,max:Eo};function pa(i,t,e,n){return xa(e)?zf(i,t,e):(Eo.pad=e,Eo.soft=n?0:null,Eo.mode=n?3:0,zf(i,t,qg))}function ve(i,t){return i??t}function Yg(i,t,e){for(t=ve(t,0),e=ve(e,i.length-1);t<=e;){if(i[t]!=null)return!0;t++}return!1}function zf(i,t,e){let n=e.min,s=e.max,r=ve(n.pad,0),o=ve(s.pad,0),a=ve(n.hard,-de),l=ve(s.hard,de),c=ve(n.soft,de),u=ve(s.soft,-de),f=ve(n.mode,0),h=ve(s.mode,0),p=t-i,_=zi(p),g=mn(je(i),je(t)),m=zi(g),d=je(m-_);(p<1e-24||d>10)&&(p=0,(i==0||t==0)&&(p=1e-24,f==2&&c!=de&&(r=0),h==2&&u!=-de&&(o=0)));let S=p||g||1e3,v=zi(S),y=Mr(10,Xn(v)),I=S*(p==0?i==0?.1:1:r),C=Le(md(i-I,y/10),24),R=i>=c&&(f==1||f==3&&C<=c||f==2&&C>=c)?c:de,L=mn(a,C<R&&i>=R?R:ei(R,C)),E=S*(p==0?t==0?.1:1:o),b=Le(_a(t+E,y/10),24),A=t<=u&&(h==1||h==3&&b>=u||h==2&&b<=u)?u:-de,O=ei(l,b>A&&t<=A?A:mn(A,b));return L==O&&L==0&&(O=100),[L,O]}var $g=new Intl.NumberFormat(Er?Hg.language:"en-US"),yc=i=>$g.format(i),qn=Math,fa=qn.PI,je=qn.abs,Xn=qn.floor,Ke=qn.round,ti=qn.ceil,ei=qn.min,mn=qn.max,Mr=qn.pow,Vf=qn.sign,zi=qn.log10,fd=qn.log2,Zg=(i,t=1)=>qn.sinh(i)*t,tc=(i,t=1)=>qn.asinh(i/t),de=1/0;function Hf(i){return(zi((i^i>>31)-(i>>31))|0)+1}function lc(i,t,e){return ei(mn(i,t),e)}function fe(i){return typeof i=="function"?i:()=>i}var Jg=()=>{},dd=i=>i,pd=(i,t)=>t,Kg=i=>null,Gf=i=>!0,Wf=(i,t)=>i==t,jg=/\.\d*?(?=9{6,}|0{6,})/gm,Fs=i=>{if(_d(i)||us.has(i))return i;let t=`${i}`,e=t.match(jg);if(e==null)return i;let n=e[0].length-1;if(t.indexOf("e-")!=-1){let[s,r]=t.split("e");return+`${Fs(s)}e${r}`}return Le(i,n)};function Ds(i,t){return Fs(Le(Fs(i/t))*t)}function _a(i,t){return Fs(ti(Fs(i/t))*t)}function md(i,t){return Fs(Xn(Fs(i/t))*t)}function Le(i,t=0){if(_d(i))return i;let e=10**t,n=i*e*(1+Number.EPSILON);return Ke(n)/e}var us=new Map;function gd(i){return((""+i).split(".")[1]||"").length}function Ao(i,t,e,n){let s=[],r=n.map(gd);for(let o=t;o<e;o++){let a=je(o),l=Le(Mr(i,o),a);for(let c=0;c<n.length;c++){let u=i==10?+`${n[c]}e${o}`:n[c]*l,f=(o>=0?0:a)+(o>=r[c]?0:r[c]),h=i==10?u:Le(u,f);s.push(h),us.set(h,f)}}return s}var To={},vc=[],Sr=[null,null],hs=Array.isArray,_d=Number.isInteger,Qg=i=>i===void 0;function Xf(i){return typeof i=="string"}function xa(i){let t=!1;if(i!=null){let e=i.constructor;t=e==null||e==Object}return t}function t0(i){return i!=null&&typeof i=="object"}var e0=Object.getPrototypeOf(Uint8Array),xd="__proto__";function br(i,t=xa){let e;if(hs(i)){let n=i.find(s=>s!=null);if(hs(n)||t(n)){e=Array(i.length);for(let s=0;s<i.length;s++)e[s]=br(i[s],t)}else e=i.slice()}else if(i instanceof e0)e=i.slice();else if(t(i)){e={};for(let n in i)n!=xd&&(e[n]=br(i[n],t))}else e=i;return e}function Ze(i){let t=arguments;for(let e=1;e<t.length;e++){let n=t[e];for(let s in n)s!=xd&&(xa(i[s])?Ze(i[s],br(n[s])):i[s]=br(n[s]))}return i}var n0=0,i0=1,s0=2;function r0(i,t,e){for(let n=0,s,r=-1;n<t.length;n++){let o=t[n];if(o>r){for(s=o-1;s>=0&&i[s]==null;)i[s--]=null;for(s=o+1;s<e&&i[s]==null;)i[r=s++]=null}}}function o0(i,t){if(c0(i)){let o=i[0].slice();for(let a=1;a<i.length;a++)o.push(...i[a].slice(1));return h0(o[0])||(o=l0(o)),o}let e=new Set;for(let o=0;o<i.length;o++){let l=i[o][0],c=l.length;for(let u=0;u<c;u++)e.add(l[u])}let n=[Array.from(e).sort((o,a)=>o-a)],s=n[0].length,r=new Map;for(let o=0;o<s;o++)r.set(n[0][o],o);for(let o=0;o<i.length;o++){let a=i[o],l=a[0];for(let c=1;c<a.length;c++){let u=a[c],f=Array(s).fill(void 0),h=t?t[o][c]:i0,p=[];for(let _=0;_<u.length;_++){let g=u[_],m=r.get(l[_]);g===null?h!=n0&&(f[m]=g,h==s0&&p.push(m)):f[m]=g}r0(f,p,s),n.push(f)}}return n}var a0=typeof queueMicrotask>"u"?i=>Promise.resolve().then(i):queueMicrotask;function l0(i){let t=i[0],e=t.length,n=Array(e);for(let r=0;r<n.length;r++)n[r]=r;n.sort((r,o)=>t[r]-t[o]);let s=[];for(let r=0;r<i.length;r++){let o=i[r],a=Array(e);for(let l=0;l<e;l++)a[l]=o[n[l]];s.push(a)}return s}function c0(i){let t=i[0][0],e=t.length;for(let n=1;n<i.length;n++){let s=i[n][0];if(s.length!=e)return!1;if(s!=t){for(let r=0;r<e;r++)if(s[r]!=t[r])return!1}}return!0}function h0(i,t=100){let e=i.length;if(e<=1)return!0;let n=0,s=e-1;for(;n<=s&&i[n]==null;)n++;for(;s>=n&&i[s]==null;)s--;if(s<=n)return!0;let r=mn(1,Xn((s-n+1)/t));for(let o=i[n],a=n+r;a<=s;a+=r){let l=i[a];if(l!=null){if(l<=o)return!1;o=l}}return!0}var yd=["January","February","March","April","May","June","July","August","September","October","November","December"],vd=["Sunday","Monday","Tuesday","Wednesday","Thursday","Friday","Saturday"];function Md(i){return i.slice(0,3)}var u0=vd.map(Md),f0=yd.map(Md),d0={MMMM:yd,MMM:f0,WWWW:vd,WWW:u0};function Mo(i){return(i<10?"0":"")+i}function p0(i){return(i<10?"00":i<100?"0":"")+i}var m0={YYYY:i=>i.getFullYear(),YY:i=>(i.getFullYear()+"").slice(2),MMMM:(i,t)=>t.MMMM[i.getMonth()],MMM:(i,t)=>t.MMM[i.getMonth()],MM:i=>Mo(i.getMonth()+1),M:i=>i.getMonth()+1,DD:i=>Mo(i.getDate()),D:i=>i.getDate(),WWWW:(i,t)=>t.WWWW[i.getDay()],WWW:(i,t)=>t.WWW[i.getDay()],HH:i=>Mo(i.getHours()),H:i=>i.getHours(),h:i=>{let t=i.getHours();return t==0?12:t>12?t-12:t},AA:i=>i.getHours()>=12?"PM":"AM",aa:i=>i.getHours()>=12?"pm":"am",a:i=>i.getHours()>=12?"p":"a",mm:i=>Mo(i.getMinutes()),m:i=>i.getMinutes(),ss:i=>Mo(i.getSeconds()),s:i=>i.getSeconds(),fff:i=>p0(i.getMilliseconds())};function Mc(i,t){t=t||d0;let e=[],n=/\{([a-z]+)\}|[^{]+/gi,s;for(;s=n.exec(i);)e.push(s[0][0]=="{"?m0[s[1]]:s[0]);return r=>{let o="";for(let a=0;a<e.length;a++)o+=typeof e[a]=="string"?e[a]:e[a](r,t);return o}}var g0=new Intl.DateTimeFormat().resolvedOptions().timeZone;function _0(i,t){let e;return t=="UTC"||t=="Etc/UTC"?e=new Date(+i+i.getTimezoneOffset()*6e4):t==g0?e=i:(e=new Date(i.toLocaleString("en-US",{timeZone:t})),e.setMilliseconds(i.getMilliseconds())),e}var Sd=i=>i%1==0,ma=[1,2,2.5,5],x0=Ao(10,-32,0,ma),bd=Ao(10,0,32,ma),y0=bd.filter(Sd),Us=x0.concat(bd),Sc=`
`,wd="{YYYY}",qf=Sc+wd,Ed="{M}/{D}",wo=Sc+Ed,ha=wo+"/{YY}",Td="{aa}",v0="{h}:{mm}",xr=v0+Td,Yf=Sc+xr,$f=":{ss}",we=null;function Ad(i){let t=i*1e3,e=t*60,n=e*60,s=n*24,r=s*30,o=s*365,l=(i==1?Ao(10,0,3,ma).filter(Sd):Ao(10,-3,0,ma)).concat([t,t*5,t*10,t*15,t*30,e,e*5,e*10,e*15,e*30,n,n*2,n*3,n*4,n*6,n*8,n*12,s,s*2,s*3,s*4,s*5,s*6,s*7,s*8,s*9,s*10,s*15,r,r*2,r*3,r*4,r*6,o,o*2,o*5,o*10,o*25,o*50,o*100]),c=[[o,wd,we,we,we,we,we,we,1],[s*28,"{MMM}",qf,we,we,we,we,we,1],[s,Ed,qf,we,we,we,we,we,1],[n,"{h}"+Td,ha,we,wo,we,we,we,1],[e,xr,ha,we,wo,we,we,we,1],[t,$f,ha+" "+xr,we,wo+" "+xr,we,Yf,we,1],[i,$f+".{fff}",ha+" "+xr,we,wo+" "+xr,we,Yf,we,1]];function u(f){return(h,p,_,g,m,d)=>{let S=[],v=m>=o,y=m>=r&&m<o,I=f(_),C=Le(I*i,3),R=ec(I.getFullYear(),v?0:I.getMonth(),y||v?1:I.getDate()),L=Le(R*i,3);if(y||v){let E=y?m/r:0,b=v?m/o:0,A=C==L?C:Le(ec(R.getFullYear()+b,R.getMonth()+E,1)*i,3),O=new Date(Ke(A/i)),F=O.getFullYear(),G=O.getMonth();for(let $=0;A<=g;$++){let W=ec(F+b*$,G+E*$,1),Z=W-f(Le(W*i,3));A=Le((+W+Z)*i,3),A<=g&&S.push(A)}}else{let E=m>=s?s:m,b=Xn(_)-Xn(C),A=L+b+_a(C-L,E);S.push(A);let O=f(A),F=O.getHours()+O.getMinutes()/e+O.getSeconds()/n,G=m/n,$=h.axes[p]._space,W=d/$;for(;A=Le(A+m,i==1?0:3),!(A>g);)if(G>1){let Z=Xn(Le(F+G,6))%24,lt=f(A).getHours()-Z;lt>1&&(lt=-1),A-=lt*n,F=(F+G)%24;let _t=S[S.length-1];Le((A-_t)/m,3)*W>=.7&&S.push(A)}else S.push(A)}return S}}return[l,c,u]}var[M0,S0,b0]=Ad(1),[w0,E0,T0]=Ad(.001);Ao(2,-53,53,[1]);function Zf(i,t){return i.map(e=>e.map((n,s)=>s==0||s==8||n==null?n:t(s==1||e[8]==0?n:e[1]+n)))}function Jf(i,t){return(e,n,s,r,o)=>{let a=t.find(_=>o>=_[0])||t[t.length-1],l,c,u,f,h,p;return n.map(_=>{let g=i(_),m=g.getFullYear(),d=g.getMonth(),S=g.getDate(),v=g.getHours(),y=g.getMinutes(),I=g.getSeconds(),C=m!=l&&a[2]||d!=c&&a[3]||S!=u&&a[4]||v!=f&&a[5]||y!=h&&a[6]||I!=p&&a[7]||a[1];return l=m,c=d,u=S,f=v,h=y,p=I,C(g)})}}function A0(i,t){let e=Mc(t);return(n,s,r,o,a)=>s.map(l=>e(i(l)))}function ec(i,t,e){return new Date(i,t,e)}function Kf(i,t){return t(i)}var C0="{YYYY}-{MM}-{DD} {h}:{mm}{aa}";function jf(i,t){return(e,n,s,r)=>r==null?mc:t(i(n))}function R0(i,t){let e=i.series[t];return e.width?e.stroke(i,t):e.points.width?e.points.stroke(i,t):null}function P0(i,t){return i.series[t].fill(i,t)}var I0={show:!0,live:!0,isolate:!1,mount:Jg,markers:{show:!0,width:2,stroke:R0,fill:P0,dash:"solid"},idx:null,idxs:null,values:[]};function L0(i,t){let e=i.cursor.points,n=Qn(),s=e.size(i,t);Oe(n,So,s),Oe(n,bo,s);let r=s/-2;Oe(n,"marginLeft",r),Oe(n,"marginTop",r);let o=e.width(i,t,s);return o&&Oe(n,"borderWidth",o),n}function D0(i,t){let e=i.series[t].points;return e._fill||e._stroke}function U0(i,t){let e=i.series[t].points;return e._stroke||e._fill}function N0(i,t){return i.series[t].points.size}var nc=[0,0];function O0(i,t,e){return nc[0]=t,nc[1]=e,nc}function ua(i,t,e,n=!0){return s=>{s.button==0&&(!n||s.target==t)&&e(s)}}function ic(i,t,e,n=!0){return s=>{(!n||s.target==t)&&e(s)}}var F0={show:!0,x:!0,y:!0,lock:!1,move:O0,points:{one:!1,show:L0,size:N0,width:0,stroke:U0,fill:D0},bind:{mousedown:ua,mouseup:ua,click:ua,dblclick:ua,mousemove:ic,mouseleave:ic,mouseenter:ic},drag:{setScale:!0,x:!0,y:!1,dist:0,uni:null,click:(i,t)=>{t.stopPropagation(),t.stopImmediatePropagation()},_x:!1,_y:!1},focus:{dist:(i,t,e,n,s)=>n-s,prox:-1,bias:0},hover:{skip:[void 0],prox:null,bias:0},left:-10,top:-10,idx:null,dataIdx:null,idxs:null,event:null},Cd={show:!0,stroke:"rgba(0,0,0,0.07)",width:2},bc=Ze({},Cd,{filter:pd}),Rd=Ze({},bc,{size:10}),Pd=Ze({},Cd,{show:!1}),wc='12px system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji"',Id="bold "+wc,Ld=1.5,Qf={show:!0,scale:"x",stroke:pc,space:50,gap:5,size:50,labelGap:0,labelSize:30,labelFont:Id,side:2,grid:bc,ticks:Rd,border:Pd,font:wc,lineGap:Ld,rotate:0},B0="Value",k0="Time",td={show:!0,scale:"x",auto:!1,sorted:1,min:de,max:-de,idxs:[]};function z0(i,t,e,n,s){return t.map(r=>r==null?"":yc(r))}function V0(i,t,e,n,s,r,o){let a=[],l=us.get(s)||0;e=o?e:Le(_a(e,s),l);for(let c=e;c<=n;c=Le(c+s,l))a.push(Object.is(c,-0)?0:c);return a}function cc(i,t,e,n,s,r,o){let a=[],l=i.scales[i.axes[t].scale].log,c=l==10?zi:fd,u=Xn(c(e));s=Mr(l,u),l==10&&(s=Us[hi(s,Us)]);let f=e,h=s*l;l==10&&(h=Us[hi(h,Us)]);do a.push(f),f=f+s,l==10&&!us.has(f)&&(f=Le(f,us.get(s))),f>=h&&(s=f,h=s*l,l==10&&(h=Us[hi(h,Us)]));while(f<=n);return a}function H0(i,t,e,n,s,r,o){let l=i.scales[i.axes[t].scale].asinh,c=n>l?cc(i,t,mn(l,e),n,s):[l],u=n>=0&&e<=0?[0]:[];return(e<-l?cc(i,t,mn(l,-n),-e,s):[l]).reverse().map(h=>-h).concat(u,c)}var Dd=/./,G0=/[12357]/,W0=/[125]/,ed=/1/,hc=(i,t,e,n)=>i.map((s,r)=>t==4&&s==0||r%n==0&&e.test(s.toExponential()[s<0?1:0])?s:null);function X0(i,t,e,n,s){let r=i.axes[e],o=r.scale,a=i.scales[o],l=i.valToPos,c=r._space,u=l(10,o),f=l(9,o)-u>=c?Dd:l(7,o)-u>=c?G0:l(5,o)-u>=c?W0:ed;if(f==ed){let h=je(l(1,o)-u);if(h<c)return hc(t.slice().reverse(),a.distr,f,ti(c/h)).reverse()}return hc(t,a.distr,f,1)}function q0(i,t,e,n,s){let r=i.axes[e],o=r.scale,a=r._space,l=i.valToPos,c=je(l(1,o)-l(2,o));return c<a?hc(t.slice().reverse(),3,Dd,ti(a/c)).reverse():t}function Y0(i,t,e,n){return n==null?mc:t==null?"":yc(t)}var nd={show:!0,scale:"y",stroke:pc,space:30,gap:5,size:50,labelGap:0,labelSize:30,labelFont:Id,side:3,grid:bc,ticks:Rd,border:Pd,font:wc,lineGap:Ld,rotate:0};function $0(i,t){let e=3+(i||1)*2;return Le(e*t,3)}function Z0(i,t){let{scale:e,idxs:n}=i.series[0],s=i._data[0],r=i.valToPos(s[n[0]],e,!0),o=i.valToPos(s[n[1]],e,!0),a=je(o-r),l=i.series[t],c=a/(l.points.space*Se);return n[1]-n[0]<=c}var id={scale:null,auto:!0,sorted:0,min:de,max:-de},Ud=(i,t,e,n,s)=>s,sd={show:!0,auto:!0,sorted:0,gaps:Ud,alpha:1,facets:[Ze({},id,{scale:"x"}),Ze({},id,{scale:"y"})]},rd={scale:"y",auto:!0,sorted:0,show:!0,spanGaps:!1,gaps:Ud,alpha:1,points:{show:Z0,filter:null},values:null,min:de,max:-de,idxs:[],path:null,clip:null};function J0(i,t,e,n,s){return e/10}var Nd={time:!0,auto:!0,distr:1,log:10,asinh:1,min:null,max:null,dir:1,ori:0},K0=Ze({},Nd,{time:!1,ori:1}),od={};function Od(i,t){let e=od[i];return e||(e={key:i,plots:[],sub(n){e.plots.push(n)},unsub(n){e.plots=e.plots.filter(s=>s!=n)},pub(n,s,r,o,a,l,c){for(let u=0;u<e.plots.length;u++)e.plots[u]!=s&&e.plots[u].pub(n,s,r,o,a,l,c)}},i!=null&&(od[i]=e)),e}var wr=1,uc=2;function Bs(i,t,e){let n=i.mode,s=i.series[t],r=n==2?i._data[t]:i._data,o=i.scales,a=i.bbox,l=r[0],c=n==2?r[1]:r[t],u=n==2?o[s.facets[0].scale]:o[i.series[0].scale],f=n==2?o[s.facets[1].scale]:o[s.scale],h=a.left,p=a.top,_=a.width,g=a.height,m=i.valToPosH,d=i.valToPosV;return u.ori==0?e(s,l,c,u,f,m,d,h,p,_,g,va,Tr,Sa,Bd,zd):e(s,l,c,u,f,d,m,p,h,g,_,Ma,Ar,Ac,kd,Vd)}function Ec(i,t){let e=0,n=0,s=ve(i.bands,vc);for(let r=0;r<s.length;r++){let o=s[r];o.series[0]==t?e=o.dir:o.series[1]==t&&(o.dir==1?n|=1:n|=2)}return[e,n==1?-1:n==2?1:n==3?2:0]}function j0(i,t,e,n,s){let r=i.mode,o=i.series[t],a=r==2?o.facets[1].scale:o.scale,l=i.scales[a];return s==-1?l.min:s==1?l.max:l.distr==3?l.dir==1?l.min:l.max:0}function Vi(i,t,e,n,s,r){return Bs(i,t,(o,a,l,c,u,f,h,p,_,g,m)=>{let d=o.pxRound,S=c.dir*(c.ori==0?1:-1),v=c.ori==0?Tr:Ar,y,I;S==1?(y=e,I=n):(y=n,I=e);let C=d(f(a[y],c,g,p)),R=d(h(l[y],u,m,_)),L=d(f(a[I],c,g,p)),E=d(h(r==1?u.max:u.min,u,m,_)),b=new Path2D(s);return v(b,L,E),v(b,C,E),v(b,C,R),b})}function ya(i,t,e,n,s,r){let o=null;if(i.length>0){o=new Path2D;let a=t==0?Sa:Ac,l=e;for(let f=0;f<i.length;f++){let h=i[f];if(h[1]>h[0]){let p=h[0]-l;p>0&&a(o,l,n,p,n+r),l=h[1]}}let c=e+s-l,u=10;c>0&&a(o,l,n-u/2,c,n+r+u)}return o}function Q0(i,t,e){let n=i[i.length-1];n&&n[0]==t?n[1]=e:i.push([t,e])}function Tc(i,t,e,n,s,r,o){let a=[],l=i.length;for(let c=s==1?e:n;c>=e&&c<=n;c+=s)if(t[c]===null){let f=c,h=c;if(s==1)for(;++c<=n&&t[c]===null;)h=c;else for(;--c>=e&&t[c]===null;)h=c;let p=r(i[f]),_=h==f?p:r(i[h]),g=f-s;p=o<=0&&g>=0&&g<l?r(i[g]):p;let d=h+s;_=o>=0&&d>=0&&d<l?r(i[d]):_,_>=p&&a.push([p,_])}return a}function ad(i){return i==0?dd:i==1?Ke:t=>Ds(t,i)}function Fd(i){let t=i==0?va:Ma,e=i==0?(s,r,o,a,l,c)=>{s.arcTo(r,o,a,l,c)}:(s,r,o,a,l,c)=>{s.arcTo(o,r,l,a,c)},n=i==0?(s,r,o,a,l)=>{s.rect(r,o,a,l)}:(s,r,o,a,l)=>{s.rect(o,r,l,a)};return(s,r,o,a,l,c=0,u=0)=>{c==0&&u==0?n(s,r,o,a,l):(c=ei(c,a/2,l/2),u=ei(u,a/2,l/2),t(s,r+c,o),e(s,r+a,o,r+a,o+l,c),e(s,r+a,o+l,r,o+l,u),e(s,r,o+l,r,o,u),e(s,r,o,r+a,o,c),s.closePath())}}var va=(i,t,e)=>{i.moveTo(t,e)},Ma=(i,t,e)=>{i.moveTo(e,t)},Tr=(i,t,e)=>{i.lineTo(t,e)},Ar=(i,t,e)=>{i.lineTo(e,t)},Sa=Fd(0),Ac=Fd(1),Bd=(i,t,e,n,s,r)=>{i.arc(t,e,n,s,r)},kd=(i,t,e,n,s,r)=>{i.arc(e,t,n,s,r)},zd=(i,t,e,n,s,r,o)=>{i.bezierCurveTo(t,e,n,s,r,o)},Vd=(i,t,e,n,s,r,o)=>{i.bezierCurveTo(e,t,s,n,o,r)};function Hd(i){return(t,e,n,s,r)=>Bs(t,e,(o,a,l,c,u,f,h,p,_,g,m)=>{let{pxRound:d,points:S}=o,v,y;c.ori==0?(v=va,y=Bd):(v=Ma,y=kd);let I=Le(S.width*Se,3),C=(S.size-S.width)/2*Se,R=Le(C*2,3),L=new Path2D,E=new Path2D,{left:b,top:A,width:O,height:F}=t.bbox;Sa(E,b-R,A-R,O+R*2,F+R*2);let G=$=>{if(l[$]!=null){let W=d(f(a[$],c,g,p)),Z=d(h(l[$],u,m,_));v(L,W+C,Z),y(L,W,Z,C,0,fa*2)}};if(r)r.forEach(G);else for(let $=n;$<=s;$++)G($);return{stroke:I>0?L:null,fill:L,clip:E,flags:wr|uc}})}function Gd(i){return(t,e,n,s,r,o)=>{n!=s&&(r!=n&&o!=n&&i(t,e,n),r!=s&&o!=s&&i(t,e,s),i(t,e,o))}}var t_=Gd(Tr),e_=Gd(Ar);function Wd(i){let t=ve(i?.alignGaps,0);return(e,n,s,r)=>Bs(e,n,(o,a,l,c,u,f,h,p,_,g,m)=>{let d=o.pxRound,S=dt=>d(f(dt,c,g,p)),v=dt=>d(h(dt,u,m,_)),y,I;c.ori==0?(y=Tr,I=t_):(y=Ar,I=e_);let C=c.dir*(c.ori==0?1:-1),R={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:wr},L=R.stroke,E=de,b=-de,A,O,F,G=S(a[C==1?s:r]),$=vr(l,s,r,1*C),W=vr(l,s,r,-1*C),Z=S(a[$]),J=S(a[W]),ct=!1;for(let dt=C==1?s:r;dt>=s&&dt<=r;dt+=C){let Yt=S(a[dt]),Q=l[dt];Yt==G?Q!=null?(O=v(Q),E==de&&(y(L,Yt,O),A=O),E=ei(O,E),b=mn(O,b)):Q===null&&(ct=!0):(E!=de&&(I(L,G,E,b,A,O),F=G),Q!=null?(O=v(Q),y(L,Yt,O),E=b=A=O):(E=de,b=-de,Q===null&&(ct=!0)),G=Yt)}E!=de&&E!=b&&F!=G&&I(L,G,E,b,A,O);let[lt,_t]=Ec(e,n);if(o.fill!=null||lt!=0){let dt=R.fill=new Path2D(L),Yt=o.fillTo(e,n,o.min,o.max,lt),Q=v(Yt);y(dt,J,Q),y(dt,Z,Q)}if(!o.spanGaps){let dt=[];ct&&dt.push(...Tc(a,l,s,r,C,S,t)),R.gaps=dt=o.gaps(e,n,s,r,dt),R.clip=ya(dt,c.ori,p,_,g,m)}return _t!=0&&(R.band=_t==2?[Vi(e,n,s,r,L,-1),Vi(e,n,s,r,L,1)]:Vi(e,n,s,r,L,_t)),R})}function n_(i){let t=ve(i.align,1),e=ve(i.ascDesc,!1),n=ve(i.alignGaps,0),s=ve(i.extend,!1);return(r,o,a,l)=>Bs(r,o,(c,u,f,h,p,_,g,m,d,S,v)=>{let y=c.pxRound,{left:I,width:C}=r.bbox,R=lt=>y(_(lt,h,S,m)),L=lt=>y(g(lt,p,v,d)),E=h.ori==0?Tr:Ar,b={stroke:new Path2D,fill:null,clip:null,band:null,gaps:null,flags:wr},A=b.stroke,O=h.dir*(h.ori==0?1:-1);a=vr(f,a,l,1),l=vr(f,a,l,-1);let F=L(f[O==1?a:l]),G=R(u[O==1?a:l]),$=G,W=G;s&&t==-1&&(W=I,E(A,W,F)),E(A,G,F);for(let lt=O==1?a:l;lt>=a&&lt<=l;lt+=O){let _t=f[lt];if(_t==null)continue;let dt=R(u[lt]),Yt=L(_t);t==1?E(A,dt,F):E(A,$,Yt),E(A,dt,Yt),F=Yt,$=dt}let Z=$;s&&t==1&&(Z=I+C,E(A,Z,F));let[J,ct]=Ec(r,o);if(c.fill!=null||J!=0){let lt=b.fill=new Path2D(A),_t=c.fillTo(r,o,c.min,c.max,J),dt=L(_t);E(lt,Z,dt),E(lt,W,dt)}if(!c.spanGaps){let lt=[];lt.push(...Tc(u,f,a,l,O,R,n));let _t=c.width*Se/2,dt=e||t==1?_t:-_t,Yt=e||t==-1?-_t:_t;lt.forEach(Q=>{Q[0]+=dt,Q[1]+=Yt}),b.gaps=lt=c.gaps(r,o,a,l,lt),b.clip=ya(lt,h.ori,m,d,S,v)}return ct!=0&&(b.band=ct==2?[Vi(r,o,a,l,A,-1),Vi(r,o,a,l,A,1)]:Vi(r,o,a,l,A,ct)),b})}function ld(i,t,e,n,s,r,o=de){if(i.length>1){let a=null;for(let l=0,c=1/0;l<i.length;l++)if(t[l]!==void 0){if(a!=null){let u=je(i[l]-i[a]);u<c&&(c=u,o=je(e(i[l],n,s,r)-e(i[a],n,s,r)))}a=l}}return o}function i_(i){i=i||To;let t=ve(i.size,[.6,de,1]),e=i.align||0,n=i.gap||0,s=i.radius;s=s==null?[0,0]:typeof s=="number"?[s,0]:s;let r=fe(s),o=1-t[0],a=ve(t[1],de),l=ve(t[2],1),c=ve(i.disp,To),u=ve(i.each,p=>{}),{fill:f,stroke:h}=c;return(p,_,g,m)=>Bs(p,_,(d,S,v,y,I,C,R,L,E,b,A)=>{let O=d.pxRound,F=e,G=n*Se,$=a*Se,W=l*Se,Z,J;y.ori==0?[Z,J]=r(p,_):[J,Z]=r(p,_);let ct=y.dir*(y.ori==0?1:-1),lt=y.ori==0?Sa:Ac,_t=y.ori==0?u:(et,it,kt,vt,wt,Kt,ut)=>{u(et,it,kt,wt,vt,ut,Kt)},dt=ve(p.bands,vc).find(et=>et.series[0]==_),Yt=dt!=null?dt.dir:0,Q=d.fillTo(p,_,d.min,d.max,Yt),ht=O(R(Q,I,A,E)),Bt,pt,zt,j=b,st=O(d.width*Se),It=!1,yt=null,Zt=null,N=null,le=null;f!=null&&(st==0||h!=null)&&(It=!0,yt=f.values(p,_,g,m),Zt=new Map,new Set(yt).forEach(et=>{et!=null&&Zt.set(et,new Path2D)}),st>0&&(N=h.values(p,_,g,m),le=new Map,new Set(N).forEach(et=>{et!=null&&le.set(et,new Path2D)})));let{x0:Qt,size:$t}=c;if(Qt!=null&&$t!=null){F=1,S=Qt.values(p,_,g,m),Qt.unit==2&&(S=S.map(kt=>p.posToVal(L+kt*b,y.key,!0)));let et=$t.values(p,_,g,m);$t.unit==2?pt=et[0]*b:pt=C(et[0],y,b,L)-C(0,y,b,L),j=ld(S,v,C,y,b,L,j),zt=j-pt+G}else j=ld(S,v,C,y,b,L,j),zt=j*o+G,pt=j-zt;zt<1&&(zt=0),st>=pt/2&&(st=0),zt<5&&(O=dd);let Dt=zt>0,me=j-zt-(Dt?st:0);pt=O(lc(me,W,$)),Bt=(F==0?pt/2:F==ct?0:pt)-F*ct*((F==0?G/2:0)+(Dt?st/2:0));let Tt={stroke:null,fill:null,clip:null,band:null,gaps:null,flags:0},P=It?null:new Path2D,M=null;if(dt!=null)M=p.data[dt.series[1]];else{let{y0:et,y1:it}=c;et!=null&&it!=null&&(v=it.values(p,_,g,m),M=et.values(p,_,g,m))}let V=Z*pt,rt=J*pt;for(let et=ct==1?g:m;et>=g&&et<=m;et+=ct){let it=v[et];if(it==null)continue;if(M!=null){let qt=M[et]??0;if(it-qt==0)continue;ht=R(qt,I,A,E)}let kt=y.distr!=2||c!=null?S[et]:et,vt=C(kt,y,b,L),wt=R(ve(it,Q),I,A,E),Kt=O(vt-Bt),ut=O(mn(wt,ht)),Mt=O(ei(wt,ht)),Wt=ut-Mt;if(it!=null){let qt=it<0?rt:V,At=it<0?V:rt;It?(st>0&&N[et]!=null&&lt(le.get(N[et]),Kt,Mt+Xn(st/2),pt,mn(0,Wt-st),qt,At),yt[et]!=null&&lt(Zt.get(yt[et]),Kt,Mt+Xn(st/2),pt,mn(0,Wt-st),qt,At)):lt(P,Kt,Mt+Xn(st/2),pt,mn(0,Wt-st),qt,At),_t(p,_,et,Kt-st/2,Mt,pt+st,Wt)}}return st>0?Tt.stroke=It?le:P:It||(Tt._fill=d.width==0?d._fill:d._stroke??d._fill,Tt.width=0),Tt.fill=It?Zt:P,Tt})}function s_(i,t){let e=ve(t?.alignGaps,0);return(n,s,r,o)=>Bs(n,s,(a,l,c,u,f,h,p,_,g,m,d)=>{let S=a.pxRound,v=Z=>S(h(Z,u,m,_)),y=Z=>S(p(Z,f,d,g)),I,C,R;u.ori==0?(I=va,R=Tr,C=zd):(I=Ma,R=Ar,C=Vd);let L=u.dir*(u.ori==0?1:-1);r=vr(c,r,o,1),o=vr(c,r,o,-1);let E=v(l[L==1?r:o]),b=E,A=[],O=[];for(let Z=L==1?r:o;Z>=r&&Z<=o;Z+=L)if(c[Z]!=null){let ct=l[Z],lt=v(ct);A.push(b=lt),O.push(y(c[Z]))}let F={stroke:i(A,O,I,R,C,S),fill:null,clip:null,band:null,gaps:null,flags:wr},G=F.stroke,[$,W]=Ec(n,s);if(a.fill!=null||$!=0){let Z=F.fill=new Path2D(G),J=a.fillTo(n,s,a.min,a.max,$),ct=y(J);R(Z,b,ct),R(Z,E,ct)}if(!a.spanGaps){let Z=[];Z.push(...Tc(l,c,r,o,L,v,e)),F.gaps=Z=a.gaps(n,s,r,o,Z),F.clip=ya(Z,u.ori,_,g,m,d)}return W!=0&&(F.band=W==2?[Vi(n,s,r,o,G,-1),Vi(n,s,r,o,G,1)]:Vi(n,s,r,o,G,W)),F})}function r_(i){return s_(o_,i)}function o_(i,t,e,n,s,r){let o=i.length;if(o<2)return null;let a=new Path2D;if(e(a,i[0],t[0]),o==2)n(a,i[1],t[1]);else{let l=Array(o),c=Array(o-1),u=Array(o-1),f=Array(o-1);for(let h=0;h<o-1;h++)u[h]=t[h+1]-t[h],f[h]=i[h+1]-i[h],c[h]=u[h]/f[h];l[0]=c[0];for(let h=1;h<o-1;h++)c[h]===0||c[h-1]===0||c[h-1]>0!=c[h]>0?l[h]=0:(l[h]=3*(f[h-1]+f[h])/((2*f[h]+f[h-1])/c[h-1]+(f[h]+2*f[h-1])/c[h]),isFinite(l[h])||(l[h]=0));l[o-1]=c[o-2];for(let h=0;h<o-1;h++)s(a,i[h]+f[h]/3,t[h]+l[h]*f[h]/3,i[h+1]-f[h]/3,t[h+1]-l[h+1]*f[h]/3,i[h+1],t[h+1])}return a}var fc=new Set;function cd(){for(let i of fc)i.syncRect(!0)}Er&&(Os(zg,yr,cd),Os(Vg,yr,cd,!0),Os(da,yr,()=>{dn.pxRatio=Se}));var a_=Wd(),l_=Hd();function hd(i,t,e,n){return(n?[i[0],i[1]].concat(i.slice(2)):[i[0]].concat(i.slice(1))).map((r,o)=>dc(r,o,t,e))}function c_(i,t){return i.map((e,n)=>n==0?{}:Ze({},t,e))}function dc(i,t,e,n){return Ze({},t==0?e:n,i)}function Xd(i,t,e){return t==null?Sr:[t,e]}var h_=Xd;function u_(i,t,e){return t==null?Sr:pa(t,e,xc,!0)}function qd(i,t,e,n){return t==null?Sr:ga(t,e,i.scales[n].log,!1)}var f_=qd;function Yd(i,t,e,n){return t==null?Sr:_c(t,e,i.scales[n].log,!1)}var d_=Yd;function p_(i,t,e,n,s){let r=mn(Hf(i),Hf(t)),o=t-i,a=hi(s/n*o,e);do{let l=e[a],c=n*l/o;if(c>=s&&r+(l<5?us.get(l):0)<=17)return[l,c]}while(++a<e.length);return[0,0]}function ud(i){let t,e;return i=i.replace(/(\d+)px/,(n,s)=>(t=Ke((e=+s)*Se))+"px"),[i,t,e]}function m_(i){i.show&&[i.font,i.labelFont].forEach(t=>{let e=Le(t[2]*Se,1);t[0]=t[0].replace(/[0-9.]+px/,e+"px"),t[1]=e})}function dn(i,t,e){let n={mode:ve(i.mode,1)},s=n.mode;function r(x,w){return((w.distr==3?zi(x>0?x:w.clamp(n,x,w.min,w.max,w.key)):w.distr==4?tc(x,w.asinh):w.distr==100?w.fwd(x):x)-w._min)/(w._max-w._min)}function o(x,w,D,U){let z=r(x,w);return U+D*(w.dir==-1?1-z:z)}function a(x,w,D,U){let z=r(x,w);return U+D*(w.dir==-1?z:1-z)}function l(x,w,D,U){return w.ori==0?o(x,w,D,U):a(x,w,D,U)}n.valToPosH=o,n.valToPosV=a;let c=!1;n.status=0;let u=n.root=Qn(Sg);if(i.id!=null&&(u.id=i.id),Wn(u,i.class),i.title){let x=Qn(Eg,u);x.textContent=i.title}let f=ci("canvas"),h=n.ctx=f.getContext("2d"),p=Qn(Tg,u);Os("click",p,x=>{x.target===g&&(De!=lr||Be!=cr)&&fn.click(n,x)},!0);let _=n.under=Qn(Ag,p);p.appendChild(f);let g=n.over=Qn(Cg,p);i=br(i);let m=+ve(i.pxAlign,1),d=ad(m);(i.plugins||[]).forEach(x=>{x.opts&&(i=x.opts(n,i)||i)});let S=i.ms||.001,v=n.series=s==1?hd(i.series||[],td,rd,!1):c_(i.series||[null],sd),y=n.axes=hd(i.axes||[],Qf,nd,!0),I=n.scales={},C=n.bands=i.bands||[];C.forEach(x=>{x.fill=fe(x.fill||null),x.dir=ve(x.dir,-1)});let R=s==2?v[1].facets[0].scale:v[0].scale,L={axes:Ym,series:Pe},E=(i.drawOrder||["axes","series"]).map(x=>L[x]);function b(x){let w=I[x];if(w==null){let D=(i.scales||To)[x]||To;if(D.from!=null)b(D.from),I[x]=Ze({},I[D.from],D,{key:x});else{w=I[x]=Ze({},x==R?Nd:K0,D),w.key=x;let U=w.time,z=w.range,K=hs(z);if((x!=R||s==2&&!U)&&(K&&(z[0]==null||z[1]==null)&&(z={min:z[0]==null?kf:{mode:1,hard:z[0],soft:z[0]},max:z[1]==null?kf:{mode:1,hard:z[1],soft:z[1]}},K=!1),!K&&xa(z))){let ot=z;z=(ft,xt,Pt)=>xt==null?Sr:pa(xt,Pt,ot)}w.range=fe(z||(U?h_:x==R?w.distr==3?f_:w.distr==4?d_:Xd:w.distr==3?qd:w.distr==4?Yd:u_)),w.auto=fe(K?!1:w.auto),w.clamp=fe(w.clamp||J0),w._min=w._max=null}}}b("x"),b("y"),s==1&&v.forEach(x=>{b(x.scale)}),y.forEach(x=>{b(x.scale)});for(let x in i.scales)b(x);let A=I[R],O=A.distr,F,G;A.ori==0?(Wn(u,bg),F=o,G=a):(Wn(u,wg),F=a,G=o);let $={};for(let x in I){let w=I[x];(w.min!=null||w.max!=null)&&($[x]={min:w.min,max:w.max},w.min=w.max=null)}let W=i.tzDate||(x=>new Date(Ke(x/S))),Z=i.fmtDate||Mc,J=S==1?b0(W):T0(W),ct=Jf(W,Zf(S==1?S0:E0,Z)),lt=jf(W,Kf(C0,Z)),_t=[],dt=n.legend=Ze({},I0,i.legend),Yt=dt.show,Q=dt.markers;dt.idxs=_t,Q.width=fe(Q.width),Q.dash=fe(Q.dash),Q.stroke=fe(Q.stroke),Q.fill=fe(Q.fill);let ht,Bt,pt,zt=[],j=[],st,It=!1,yt={};if(dt.live){let x=v[1]?v[1].values:null;It=x!=null,st=It?x(n,1,0):{_:0};for(let w in st)yt[w]=mc}if(Yt)if(ht=ci("table",Ug,u),pt=ci("tbody",null,ht),dt.mount(n,ht),It){Bt=ci("thead",null,ht,pt);let x=ci("tr",null,Bt);ci("th",null,x);for(var Zt in st)ci("th",Ef,x).textContent=Zt}else Wn(ht,Og),dt.live&&Wn(ht,Ng);let N={show:!0},le={show:!1};function Qt(x,w){if(w==0&&(It||!dt.live||s==2))return Sr;let D=[],U=ci("tr",Fg,pt,pt.childNodes[w]);Wn(U,x.class),x.show||Wn(U,Ns);let z=ci("th",null,U);if(Q.show){let ft=Qn(Bg,z);if(w>0){let xt=Q.width(n,w);xt&&(ft.style.border=xt+"px "+Q.dash(n,w)+" "+Q.stroke(n,w)),ft.style.background=Q.fill(n,w)}}let K=Qn(Ef,z);K.textContent=x.label,w>0&&(Q.show||(K.style.color=x.width>0?Q.stroke(n,w):Q.fill(n,w)),Dt("click",z,ft=>{if(Ut._lock)return;ce(ft);let xt=v.indexOf(x);if((ft.ctrlKey||ft.metaKey)!=dt.isolate){let Pt=v.some((Lt,Ot)=>Ot>0&&Ot!=xt&&Lt.show);v.forEach((Lt,Ot)=>{Ot>0&&wi(Ot,Pt?Ot==xt?N:le:N,!0,qe.setSeries)})}else wi(xt,{show:!x.show},!0,qe.setSeries)},!1),Ni&&Dt(Pf,z,ft=>{Ut._lock||(ce(ft),wi(v.indexOf(x),ur,!0,qe.setSeries))},!1));for(var ot in st){let ft=ci("td",kg,U);ft.textContent="--",D.push(ft)}return[U,D]}let $t=new Map;function Dt(x,w,D,U=!0){let z=$t.get(w)||{},K=Ut.bind[x](n,w,D,U);K&&(Os(x,w,z[x]=K),$t.set(w,z))}function me(x,w,D){let U=$t.get(w)||{};for(let z in U)(x==null||z==x)&&(ac(z,w,U[z]),delete U[z]);x==null&&$t.delete(w)}let Tt=0,P=0,M=0,V=0,rt=0,et=0,it=rt,kt=et,vt=M,wt=V,Kt=0,ut=0,Mt=0,Wt=0;n.bbox={};let qt=!1,At=!1,re=!1,jt=!1,Me=!1,B=!1;function St(x,w,D){(D||x!=n.width||w!=n.height)&&nt(x,w),sr(!1),re=!0,At=!0,rr()}function nt(x,w){n.width=Tt=M=x,n.height=P=V=w,rt=et=0,ne(),Fe();let D=n.bbox;Kt=D.left=Ds(rt*Se,.5),ut=D.top=Ds(et*Se,.5),Mt=D.width=Ds(M*Se,.5),Wt=D.height=Ds(V*Se,.5)}let at=3;function Rt(){let x=!1,w=0;for(;!x;){w++;let D=Xm(w),U=qm(w);x=w==at||D&&U,x||(nt(n.width,n.height),At=!0)}}function Ct({width:x,height:w}){St(x,w)}n.setSize=Ct;function ne(){let x=!1,w=!1,D=!1,U=!1;y.forEach((z,K)=>{if(z.show&&z._show){let{side:ot,_size:ft}=z,xt=ot%2,Pt=z.label!=null?z.labelSize:0,Lt=ft+Pt;Lt>0&&(xt?(M-=Lt,ot==3?(rt+=Lt,U=!0):D=!0):(V-=Lt,ot==0?(et+=Lt,x=!0):w=!0))}}),Si[0]=x,Si[1]=D,Si[2]=w,Si[3]=U,M-=bi[1]+bi[3],rt+=bi[3],V-=bi[2]+bi[0],et+=bi[0]}function Fe(){let x=rt+M,w=et+V,D=rt,U=et;function z(K,ot){switch(K){case 1:return x+=ot,x-ot;case 2:return w+=ot,w-ot;case 3:return D-=ot,D+ot;case 0:return U-=ot,U+ot}}y.forEach((K,ot)=>{if(K.show&&K._show){let ft=K.side;K._pos=z(ft,K._size),K.label!=null&&(K._lpos=z(ft,K.labelSize))}})}let Ut=n.cursor=Ze({},F0,{drag:{y:s==2}},i.cursor);if(Ut.dataIdx==null){let x=Ut.hover,w=x.skip=new Set(x.skip??[]);w.add(void 0);let D=x.prox=fe(x.prox),U=x.bias??=0;Ut.dataIdx=(z,K,ot,ft)=>{if(K==0)return ot;let xt=ot,Pt=D(z,K,ot,ft)??de,Lt=Pt>=0&&Pt<de,Ot=A.ori==0?M:V,ee=Ut.left,Ie=t[0],ge=t[K];if(w.has(ge[ot])){xt=null;let he=null,ie=null,Xt;if(U==0||U==-1)for(Xt=ot;he==null&&Xt-- >0;)w.has(ge[Xt])||(he=Xt);if(U==0||U==1)for(Xt=ot;ie==null&&Xt++<ge.length;)w.has(ge[Xt])||(ie=Xt);if(he!=null||ie!=null)if(Lt){let Ae=he==null?-1/0:F(Ie[he],A,Ot,0),We=ie==null?1/0:F(Ie[ie],A,Ot,0),ze=ee-Ae,Ne=We-ee;ze<=Ne?ze<=Pt&&(xt=he):Ne<=Pt&&(xt=ie)}else xt=ie==null?he:he==null?ie:ot-he<=ie-ot?he:ie}else Lt&&je(ee-F(Ie[ot],A,Ot,0))>Pt&&(xt=null);return xt}}let ce=x=>{Ut.event=x};Ut.idxs=_t,Ut._lock=!1;let Te=Ut.points;Te.show=fe(Te.show),Te.size=fe(Te.size),Te.stroke=fe(Te.stroke),Te.width=fe(Te.width),Te.fill=fe(Te.fill);let rn=n.focus=Ze({},i.focus||{alpha:.3},Ut.focus),Ni=rn.prox>=0,Oi=Ni&&Te.one,Xe=[],Mi=[],Fi=[];function lo(x,w){let D=Te.show(n,w);if(D)return Wn(D,Dg),Wn(D,x.class),Ri(D,-10,-10,M,V),g.insertBefore(D,Xe[w]),D}function bs(x,w){if(s==1||w>0){let D=s==1&&I[x.scale].time,U=x.value;x.value=D?Xf(U)?jf(W,Kf(U,Z)):U||lt:U||Y0,x.label=x.label||(D?k0:B0)}if(Oi||w>0){x.width=x.width==null?1:x.width,x.paths=x.paths||a_||Kg,x.fillTo=fe(x.fillTo||j0),x.pxAlign=+ve(x.pxAlign,m),x.pxRound=ad(x.pxAlign),x.stroke=fe(x.stroke||null),x.fill=fe(x.fill||null),x._stroke=x._fill=x._paths=x._focus=null;let D=$0(mn(1,x.width),1),U=x.points=Ze({},{size:D,width:mn(1,D*.2),stroke:x.stroke,space:D*2,paths:l_,_stroke:null,_fill:null},x.points);U.show=fe(U.show),U.filter=fe(U.filter),U.fill=fe(U.fill),U.stroke=fe(U.stroke),U.paths=fe(U.paths),U.pxAlign=x.pxAlign}if(Yt){let D=Qt(x,w);zt.splice(w,0,D[0]),j.splice(w,0,D[1]),dt.values.push(null)}if(Ut.show){_t.splice(w,0,null);let D=null;Oi?w==0&&(D=lo(x,w)):w>0&&(D=lo(x,w)),Xe.splice(w,0,D),Mi.splice(w,0,0),Fi.splice(w,0,0)}cn("addSeries",w)}function Yo(x,w){w=w??v.length,x=s==1?dc(x,w,td,rd):dc(x,w,{},sd),v.splice(w,0,x),bs(v[w],w)}n.addSeries=Yo;function ir(x){if(v.splice(x,1),Yt){dt.values.splice(x,1),j.splice(x,1);let w=zt.splice(x,1)[0];me(null,w.firstChild),w.remove()}Ut.show&&(_t.splice(x,1),Xe.splice(x,1)[0].remove(),Mi.splice(x,1),Fi.splice(x,1)),cn("delSeries",x)}n.delSeries=ir;let Si=[!1,!1,!1,!1];function $o(x,w){if(x._show=x.show,x.show){let D=x.side%2,U=I[x.scale];U==null&&(x.scale=D?v[1].scale:R,U=I[x.scale]);let z=U.time;x.size=fe(x.size),x.space=fe(x.space),x.rotate=fe(x.rotate),hs(x.incrs)&&x.incrs.forEach(ot=>{!us.has(ot)&&us.set(ot,gd(ot))}),x.incrs=fe(x.incrs||(U.distr==2?y0:z?S==1?M0:w0:Us)),x.splits=fe(x.splits||(z&&U.distr==1?J:U.distr==3?cc:U.distr==4?H0:V0)),x.stroke=fe(x.stroke),x.grid.stroke=fe(x.grid.stroke),x.ticks.stroke=fe(x.ticks.stroke),x.border.stroke=fe(x.border.stroke);let K=x.values;x.values=hs(K)&&!hs(K[0])?fe(K):z?hs(K)?Jf(W,Zf(K,Z)):Xf(K)?A0(W,K):K||ct:K||z0,x.filter=fe(x.filter||(U.distr>=3&&U.log==10?X0:U.distr==3&&U.log==2?q0:pd)),x.font=ud(x.font),x.labelFont=ud(x.labelFont),x._size=x.size(n,null,w,0),x._space=x._rotate=x._incrs=x._found=x._splits=x._values=null,x._size>0&&(Si[w]=!0,x._el=Qn(Rg,p))}}function ws(x,w,D,U){let[z,K,ot,ft]=D,xt=w%2,Pt=0;return xt==0&&(ft||K)&&(Pt=w==0&&!z||w==2&&!ot?Ke(Qf.size/3):0),xt==1&&(z||ot)&&(Pt=w==1&&!K||w==3&&!ft?Ke(nd.size/2):0),Pt}let Zo=n.padding=(i.padding||[ws,ws,ws,ws]).map(x=>fe(ve(x,ws))),bi=n._padding=Zo.map((x,w)=>x(n,w,Si,0)),T,k=null,X=null,tt=s==1?v[0].idxs:null,H=null,mt=!1;function Et(x,w){if(t=x??[],n.data=n._data=t,s==2){T=0;for(let D=1;D<v.length;D++)T+=t[D][0].length}else{t.length==0&&(n.data=n._data=t=[[]]),H=t[0],T=H.length;let D=t;if(O==2){D=t.slice();let U=D[0]=Array(T);for(let z=0;z<T;z++)U[z]=z}n._data=t=D}if(sr(!0),cn("setData"),O==2&&(re=!0),w!==!1){let D=A;D.auto(n,mt)?Ht():is(R,D.min,D.max),jt=jt||Ut.left>=0,B=!0,rr()}}n.setData=Et;function Ht(){mt=!0;let x,w;s==1&&(T>0?(k=tt[0]=0,X=tt[1]=T-1,x=t[0][k],w=t[0][X],O==2?(x=k,w=X):x==w&&(O==3?[x,w]=ga(x,x,A.log,!1):O==4?[x,w]=_c(x,x,A.log,!1):A.time?w=x+Ke(86400/S):[x,w]=pa(x,w,xc,!0))):(k=tt[0]=x=null,X=tt[1]=w=null)),is(R,x,w)}let Vt,Jt,te,Gt,ue,be,Ee,on,_e,Nt;function Zn(x,w,D,U,z,K){x??=Af,D??=vc,U??="butt",z??=Af,K??="round",x!=Vt&&(h.strokeStyle=Vt=x),z!=Jt&&(h.fillStyle=Jt=z),w!=te&&(h.lineWidth=te=w),K!=ue&&(h.lineJoin=ue=K),U!=be&&(h.lineCap=be=U),D!=Gt&&h.setLineDash(Gt=D)}function xe(x,w,D,U){w!=Jt&&(h.fillStyle=Jt=w),x!=Ee&&(h.font=Ee=x),D!=on&&(h.textAlign=on=D),U!=_e&&(h.textBaseline=_e=U)}function yn(x,w,D,U,z=0){if(U.length>0&&x.auto(n,mt)&&(w==null||w.min==null)){let K=ve(k,0),ot=ve(X,U.length-1),ft=D.min==null?x.distr==3?Xg(U,K,ot):Wg(U,K,ot,z):[D.min,D.max];x.min=ei(x.min,D.min=ft[0]),x.max=mn(x.max,D.max=ft[1])}}let Bi={min:null,max:null};function vn(){for(let U in I){let z=I[U];$[U]==null&&(z.min==null||$[R]!=null&&z.auto(n,mt))&&($[U]=Bi)}for(let U in I){let z=I[U];$[U]==null&&z.from!=null&&$[z.from]!=null&&($[U]=Bi)}$[R]!=null&&sr(!0);let x={};for(let U in $){let z=$[U];if(z!=null){let K=x[U]=br(I[U],t0);if(z.min!=null)Ze(K,z);else if(U!=R||s==2)if(T==0&&K.from==null){let ot=K.range(n,null,null,U);K.min=ot[0],K.max=ot[1]}else K.min=de,K.max=-de}}if(T>0){v.forEach((U,z)=>{if(s==1){let K=U.scale,ot=$[K];if(ot==null)return;let ft=x[K];if(z==0){let xt=ft.range(n,ft.min,ft.max,K);ft.min=xt[0],ft.max=xt[1],k=hi(ft.min,t[0]),X=hi(ft.max,t[0]),X-k>1&&(t[0][k]<ft.min&&k++,t[0][X]>ft.max&&X--),U.min=H[k],U.max=H[X]}else U.show&&U.auto&&yn(ft,ot,U,t[z],U.sorted);U.idxs[0]=k,U.idxs[1]=X}else if(z>0&&U.show&&U.auto){let[K,ot]=U.facets,ft=K.scale,xt=ot.scale,[Pt,Lt]=t[z],Ot=x[ft],ee=x[xt];Ot!=null&&yn(Ot,$[ft],K,Pt,K.sorted),ee!=null&&yn(ee,$[xt],ot,Lt,ot.sorted),U.min=ot.min,U.max=ot.max}});for(let U in x){let z=x[U],K=$[U];if(z.from==null&&(K==null||K.min==null)){let ot=z.range(n,z.min==de?null:z.min,z.max==-de?null:z.max,U);z.min=ot[0],z.max=ot[1]}}}for(let U in x){let z=x[U];if(z.from!=null){let K=x[z.from];if(K.min==null)z.min=z.max=null;else{let ot=z.range(n,K.min,K.max,U);z.min=ot[0],z.max=ot[1]}}}let w={},D=!1;for(let U in x){let z=x[U],K=I[U];if(K.min!=z.min||K.max!=z.max){K.min=z.min,K.max=z.max;let ot=K.distr;K._min=ot==3?zi(K.min):ot==4?tc(K.min,K.asinh):ot==100?K.fwd(K.min):K.min,K._max=ot==3?zi(K.max):ot==4?tc(K.max,K.asinh):ot==100?K.fwd(K.max):K.max,w[U]=D=!0}}if(D){v.forEach((U,z)=>{s==2?z>0&&w.y&&(U._paths=null):w[U.scale]&&(U._paths=null)});for(let U in w)re=!0,cn("setScale",U);Ut.show&&Ut.left>=0&&(jt=B=!0)}for(let U in $)$[U]=null}function Es(x){let w=lc(k-1,0,T-1),D=lc(X+1,0,T-1);for(;x[w]==null&&w>0;)w--;for(;x[D]==null&&D<T-1;)D++;return[w,D]}function Pe(){T>0&&(v.forEach((x,w)=>{if(w>0&&x.show&&(zn(w,!1),zn(w,!0),x._paths==null)){Nt!=x.alpha&&(h.globalAlpha=Nt=x.alpha);let D=s==2?[0,t[w][0].length-1]:Es(t[w]);x._paths=x.paths(n,w,D[0],D[1]),Nt!=1&&(h.globalAlpha=Nt=1)}}),v.forEach((x,w)=>{if(w>0&&x.show){Nt!=x.alpha&&(h.globalAlpha=Nt=x.alpha),x._paths!=null&&es(w,!1);{let D=x._paths!=null?x._paths.gaps:null,U=x.points.show(n,w,k,X,D),z=x.points.filter(n,w,U,D);(U||z)&&(x.points._paths=x.points.paths(n,w,k,X,z),es(w,!0))}Nt!=1&&(h.globalAlpha=Nt=1),cn("drawSeries",w)}}))}function zn(x,w){let D=w?v[x].points:v[x];D._stroke=D.stroke(n,x),D._fill=D.fill(n,x)}function es(x,w){let D=w?v[x].points:v[x],{stroke:U,fill:z,clip:K,flags:ot,_stroke:ft=D._stroke,_fill:xt=D._fill,_width:Pt=D.width}=D._paths;Pt=Le(Pt*Se,3);let Lt=null,Ot=Pt%2/2;w&&xt==null&&(xt=Pt>0?"#fff":ft);let ee=D.pxAlign==1&&Ot>0;if(ee&&h.translate(Ot,Ot),!w){let Ie=Kt-Pt/2,ge=ut-Pt/2,he=Mt+Pt,ie=Wt+Pt;Lt=new Path2D,Lt.rect(Ie,ge,he,ie)}w?Jn(ft,Pt,D.dash,D.cap,xt,U,z,ot,K):Pn(x,ft,Pt,D.dash,D.cap,xt,U,z,ot,Lt,K),ee&&h.translate(-Ot,-Ot)}function Pn(x,w,D,U,z,K,ot,ft,xt,Pt,Lt){let Ot=!1;xt!=0&&C.forEach((ee,Ie)=>{if(ee.series[0]==x){let ge=v[ee.series[1]],he=t[ee.series[1]],ie=(ge._paths||To).band;hs(ie)&&(ie=ee.dir==1?ie[0]:ie[1]);let Xt,Ae=null;ge.show&&ie&&Yg(he,k,X)?(Ae=ee.fill(n,Ie)||K,Xt=ge._paths.clip):ie=null,Jn(w,D,U,z,Ae,ot,ft,xt,Pt,Lt,Xt,ie),Ot=!0}}),Ot||Jn(w,D,U,z,K,ot,ft,xt,Pt,Lt)}let si=wr|uc;function Jn(x,w,D,U,z,K,ot,ft,xt,Pt,Lt,Ot){Zn(x,w,D,U,z),(xt||Pt||Ot)&&(h.save(),xt&&h.clip(xt),Pt&&h.clip(Pt)),Ot?(ft&si)==si?(h.clip(Ot),Lt&&h.clip(Lt),Jo(z,ot),Ts(x,K,w)):ft&uc?(Jo(z,ot),h.clip(Ot),Ts(x,K,w)):ft&wr&&(h.save(),h.clip(Ot),Lt&&h.clip(Lt),Jo(z,ot),h.restore(),Ts(x,K,w)):(Jo(z,ot),Ts(x,K,w)),(xt||Pt||Ot)&&h.restore()}function Ts(x,w,D){D>0&&(w instanceof Map?w.forEach((U,z)=>{h.strokeStyle=Vt=z,h.stroke(U)}):w!=null&&x&&h.stroke(w))}function Jo(x,w){w instanceof Map?w.forEach((D,U)=>{h.fillStyle=Jt=U,h.fill(D)}):w!=null&&x&&h.fill(w)}function Wm(x,w,D,U){let z=y[x],K;if(U<=0)K=[0,0];else{let ot=z._space=z.space(n,x,w,D,U),ft=z._incrs=z.incrs(n,x,w,D,U,ot);K=p_(w,D,ft,U,ot)}return z._found=K}function Il(x,w,D,U,z,K,ot,ft,xt,Pt){let Lt=ot%2/2;m==1&&h.translate(Lt,Lt),Zn(ft,ot,xt,Pt,ft),h.beginPath();let Ot,ee,Ie,ge,he=z+(U==0||U==3?-K:K);D==0?(ee=z,ge=he):(Ot=z,Ie=he);for(let ie=0;ie<x.length;ie++)w[ie]!=null&&(D==0?Ot=Ie=x[ie]:ee=ge=x[ie],h.moveTo(Ot,ee),h.lineTo(Ie,ge));h.stroke(),m==1&&h.translate(-Lt,-Lt)}function Xm(x){let w=!0;return y.forEach((D,U)=>{if(!D.show)return;let z=I[D.scale];if(z.min==null){D._show&&(w=!1,D._show=!1,sr(!1));return}else D._show||(w=!1,D._show=!0,sr(!1));let K=D.side,ot=K%2,{min:ft,max:xt}=z,[Pt,Lt]=Wm(U,ft,xt,ot==0?M:V);if(Lt==0)return;let Ot=z.distr==2,ee=D._splits=D.splits(n,U,ft,xt,Pt,Lt,Ot),Ie=z.distr==2?ee.map(Xt=>H[Xt]):ee,ge=z.distr==2?H[ee[1]]-H[ee[0]]:Pt,he=D._values=D.values(n,D.filter(n,Ie,U,Lt,ge),U,Lt,ge);D._rotate=K==2?D.rotate(n,he,U,Lt):0;let ie=D._size;D._size=ti(D.size(n,he,U,x)),ie!=null&&D._size!=ie&&(w=!1)}),w}function qm(x){let w=!0;return Zo.forEach((D,U)=>{let z=D(n,U,Si,x);z!=bi[U]&&(w=!1),bi[U]=z}),w}function Ym(){for(let x=0;x<y.length;x++){let w=y[x];if(!w.show||!w._show)continue;let D=w.side,U=D%2,z,K,ot=w.stroke(n,x),ft=D==0||D==3?-1:1;if(w.label){let bn=w.labelGap*ft,Vn=Ke((w._lpos+bn)*Se);xe(w.labelFont[0],ot,"center",D==2?vo:Tf),h.save(),U==1?(z=K=0,h.translate(Vn,Ke(ut+Wt/2)),h.rotate((D==3?-fa:fa)/2)):(z=Ke(Kt+Mt/2),K=Vn),h.fillText(w.label,z,K),h.restore()}let[xt,Pt]=w._found;if(Pt==0)continue;let Lt=I[w.scale],Ot=U==0?Mt:Wt,ee=U==0?Kt:ut,Ie=Ke(w.gap*Se),ge=w._splits,he=Lt.distr==2?ge.map(bn=>H[bn]):ge,ie=Lt.distr==2?H[ge[1]]-H[ge[0]]:xt,Xt=w.ticks,Ae=w.border,We=Xt.show?Ke(Xt.size*Se):0,ze=w._rotate*-fa/180,Ne=d(w._pos*Se),Ye=(We+Ie)*ft,In=Ne+Ye;K=U==0?In:0,z=U==1?In:0;let Ln=w.font[0],Kn=w.align==1?_r:w.align==2?jl:ze>0?_r:ze<0?jl:U==0?"center":D==3?jl:_r,ri=ze||U==1?"middle":D==2?vo:Tf;xe(Ln,ot,Kn,ri);let oi=w.font[1]*w.lineGap,Mn=ge.map(bn=>d(l(bn,Lt,Ot,ee))),Ti=w._values;for(let bn=0;bn<Ti.length;bn++){let Vn=Ti[bn];if(Vn!=null){U==0?z=Mn[bn]:K=Mn[bn],Vn=""+Vn;let dr=Vn.indexOf(`
`)==-1?[Vn]:Vn.split(/\n/gm);for(let os=0;os<dr.length;os++){let jn=dr[os];ze?(h.save(),h.translate(z,K+os*oi),h.rotate(ze),h.fillText(jn,0,0),h.restore()):h.fillText(jn,z,K+os*oi)}}}Xt.show&&Il(Mn,Xt.filter(n,he,x,Pt,ie),U,D,Ne,We,Le(Xt.width*Se,3),Xt.stroke(n,x),Xt.dash,Xt.cap);let Sn=w.grid;Sn.show&&Il(Mn,Sn.filter(n,he,x,Pt,ie),U,U==0?2:1,U==0?ut:Kt,U==0?Wt:Mt,Le(Sn.width*Se,3),Sn.stroke(n,x),Sn.dash,Sn.cap),Ae.show&&Il([Ne],[1],U==0?1:0,U==0?1:2,U==1?ut:Kt,U==1?Wt:Mt,Le(Ae.width*Se,3),Ae.stroke(n,x),Ae.dash,Ae.cap)}cn("drawAxes")}function sr(x){v.forEach((w,D)=>{D>0&&(w._paths=null,x&&(s==1?(w.min=null,w.max=null):w.facets.forEach(U=>{U.min=null,U.max=null})))})}let Ko=!1,Ll=!1,co=[];function $m(){Ll=!1;for(let x=0;x<co.length;x++)cn(...co[x]);co.length=0}function rr(){Ko||(a0(ku),Ko=!0)}function Zm(x,w=!1){Ko=!0,Ll=w,x(n),ku(),w&&co.length>0&&queueMicrotask($m)}n.batch=Zm;function ku(){if(qt&&(vn(),qt=!1),re&&(Rt(),re=!1),At){if(Oe(_,_r,rt),Oe(_,vo,et),Oe(_,So,M),Oe(_,bo,V),Oe(g,_r,rt),Oe(g,vo,et),Oe(g,So,M),Oe(g,bo,V),Oe(p,So,Tt),Oe(p,bo,P),f.width=Ke(Tt*Se),f.height=Ke(P*Se),y.forEach(({_el:x,_show:w,_size:D,_pos:U,side:z})=>{if(x!=null)if(w){let K=z===3||z===0?D:0,ot=z%2==1;Oe(x,ot?"left":"top",U-K),Oe(x,ot?"width":"height",D),Oe(x,ot?"top":"left",ot?et:rt),Oe(x,ot?"height":"width",ot?V:M),oc(x,Ns)}else Wn(x,Ns)}),Vt=Jt=te=ue=be=Ee=on=_e=Gt=null,Nt=1,fo(!0),rt!=it||et!=kt||M!=vt||V!=wt){sr(!1);let x=M/vt,w=V/wt;if(Ut.show&&!jt&&Ut.left>=0){Ut.left*=x,Ut.top*=w,or&&Ri(or,Ke(Ut.left),0,M,V),ar&&Ri(ar,0,Ke(Ut.top),M,V);for(let D=0;D<Xe.length;D++){let U=Xe[D];U!=null&&(Mi[D]*=x,Fi[D]*=w,Ri(U,ti(Mi[D]),ti(Fi[D]),M,V))}}if(Ue.show&&!Me&&Ue.left>=0&&Ue.width>0){Ue.left*=x,Ue.width*=x,Ue.top*=w,Ue.height*=w;for(let D in Bl)Oe(hr,D,Ue[D])}it=rt,kt=et,vt=M,wt=V}cn("setSize"),At=!1}Tt>0&&P>0&&(h.clearRect(0,0,f.width,f.height),cn("drawClear"),E.forEach(x=>x()),cn("draw")),Ue.show&&Me&&(jo(Ue),Me=!1),Ut.show&&jt&&(Cs(null,!0,!1),jt=!1),dt.show&&dt.live&&B&&(Ol(),B=!1),c||(c=!0,n.status=1,cn("ready")),mt=!1,Ko=!1}n.redraw=(x,w)=>{re=w||!1,x!==!1?is(R,A.min,A.max):rr()};function Dl(x,w){let D=I[x];if(D.from==null){if(T==0){let U=D.range(n,w.min,w.max,x);w.min=U[0],w.max=U[1]}if(w.min>w.max){let U=w.min;w.min=w.max,w.max=U}if(T>1&&w.min!=null&&w.max!=null&&w.max-w.min<1e-16)return;x==R&&D.distr==2&&T>0&&(w.min=hi(w.min,t[0]),w.max=hi(w.max,t[0]),w.min==w.max&&w.max++),$[x]=w,qt=!0,rr()}}n.setScale=Dl;let Ul,Nl,or,ar,zu,Vu,lr,cr,Hu,Gu,De,Be,ns=!1,fn=Ut.drag,an=fn.x,ln=fn.y;Ut.show&&(Ut.x&&(Ul=Qn(Ig,g)),Ut.y&&(Nl=Qn(Lg,g)),A.ori==0?(or=Ul,ar=Nl):(or=Nl,ar=Ul),De=Ut.left,Be=Ut.top);let Ue=n.select=Ze({show:!0,over:!0,left:0,width:0,top:0,height:0},i.select),hr=Ue.show?Qn(Pg,Ue.over?g:_):null;function jo(x,w){if(Ue.show){for(let D in x)Ue[D]=x[D],D in Bl&&Oe(hr,D,x[D]);w!==!1&&cn("setSelect")}}n.setSelect=jo;function Jm(x,w){let D=v[x],U=Yt?zt[x]:null;if(D.show)U&&oc(U,Ns);else{U&&Wn(U,Ns);let z=Oi?Xe[0]:Xe[x];Ri(z,-10,-10,M,V)}}function is(x,w,D){Dl(x,{min:w,max:D})}function wi(x,w,D,U){w.focus!=null&&eg(x),w.show!=null&&v.forEach((z,K)=>{K>0&&(x==K||x==null)&&(z.show=w.show,Jm(K,w.show),s==2?(is(z.facets[0].scale,null,null),is(z.facets[1].scale,null,null)):is(z.scale,null,null),rr())}),D!==!1&&cn("setSeries",x,w),U&&po("setSeries",n,x,w)}n.setSeries=wi;function Km(x,w){Ze(C[x],w)}function jm(x,w){x.fill=fe(x.fill||null),x.dir=ve(x.dir,-1),w=w??C.length,C.splice(w,0,x)}function Qm(x){x==null?C.length=0:C.splice(x,1)}n.addBand=jm,n.setBand=Km,n.delBand=Qm;function tg(x,w){v[x].alpha=w,Ut.show&&Xe[x]&&(Xe[x].style.opacity=w),Yt&&zt[x]&&(zt[x].style.opacity=w)}let ki,ss,As,ur={focus:!0};function eg(x){if(x!=As){let w=x==null,D=rn.alpha!=1;v.forEach((U,z)=>{if(s==1||z>0){let K=w||z==0||z==x;U._focus=w?null:K,D&&tg(z,K?1:rn.alpha)}}),As=x,D&&rr()}}Yt&&Ni&&Dt(If,ht,x=>{Ut._lock||(ce(x),As!=null&&wi(null,ur,!0,qe.setSeries))});function Ei(x,w,D){let U=I[w];D&&(x=x/Se-(U.ori==1?et:rt));let z=M;U.ori==1&&(z=V,x=z-x),U.dir==-1&&(x=z-x);let K=U._min,ot=U._max,ft=x/z,xt=K+(ot-K)*ft,Pt=U.distr;return Pt==3?Mr(10,xt):Pt==4?Zg(xt,U.asinh):Pt==100?U.bwd(xt):xt}function ng(x,w){let D=Ei(x,R,w);return hi(D,t[0],k,X)}n.valToIdx=x=>hi(x,t[0]),n.posToIdx=ng,n.posToVal=Ei,n.valToPos=(x,w,D)=>I[w].ori==0?o(x,I[w],D?Mt:M,D?Kt:0):a(x,I[w],D?Wt:V,D?ut:0),n.setCursor=(x,w,D)=>{De=x.left,Be=x.top,Cs(null,w,D)};function Wu(x,w){Oe(hr,_r,Ue.left=x),Oe(hr,So,Ue.width=w)}function Xu(x,w){Oe(hr,vo,Ue.top=x),Oe(hr,bo,Ue.height=w)}let ho=A.ori==0?Wu:Xu,uo=A.ori==1?Wu:Xu;function ig(){if(Yt&&dt.live)for(let x=s==2?1:0;x<v.length;x++){if(x==0&&It)continue;let w=dt.values[x],D=0;for(let U in w)j[x][D++].firstChild.nodeValue=w[U]}}function Ol(x,w){if(x!=null&&(x.idxs?x.idxs.forEach((D,U)=>{_t[U]=D}):Qg(x.idx)||_t.fill(x.idx),dt.idx=_t[0]),Yt&&dt.live){for(let D=0;D<v.length;D++)(D>0||s==1&&!It)&&sg(D,_t[D]);ig()}B=!1,w!==!1&&cn("setLegend")}n.setLegend=Ol;function sg(x,w){let D=v[x],U=x==0&&O==2?H:t[x],z;It?z=D.values(n,x,w)??yt:(z=D.value(n,w==null?null:U[w],x,w),z=z==null?yt:{_:z}),dt.values[x]=z}function Cs(x,w,D){Hu=De,Gu=Be,[De,Be]=Ut.move(n,De,Be),Ut.left=De,Ut.top=Be,Ut.show&&(or&&Ri(or,Ke(De),0,M,V),ar&&Ri(ar,0,Ke(Be),M,V));let U,z=k>X;ki=de,ss=null;let K=A.ori==0?M:V,ot=A.ori==1?M:V;if(De<0||T==0||z){U=Ut.idx=null;for(let ft=0;ft<v.length;ft++){let xt=Xe[ft];xt!=null&&Ri(xt,-10,-10,M,V)}Ni&&wi(null,ur,!0,x==null&&qe.setSeries),dt.live&&(_t.fill(U),B=!0)}else{let ft,xt,Pt;s==1&&(ft=A.ori==0?De:Be,xt=Ei(ft,R),U=Ut.idx=hi(xt,t[0],k,X),Pt=F(t[0][U],A,K,0));let Lt=-10,Ot=-10,ee=0,Ie=0,ge=!0,he="",ie="";for(let Xt=s==2?1:0;Xt<v.length;Xt++){let Ae=v[Xt],We=_t[Xt],ze=We==null?null:s==1?t[Xt][We]:t[Xt][1][We],Ne=Ut.dataIdx(n,Xt,U,xt),Ye=Ne==null?null:s==1?t[Xt][Ne]:t[Xt][1][Ne];B=B||Ye!=ze||Ne!=We,_t[Xt]=Ne;let In=Ne==U?Pt:F(s==1?t[0][Ne]:t[Xt][0][Ne],A,K,0);if(Xt>0&&Ae.show){let Ln=Ye==null?-10:G(Ye,s==1?I[Ae.scale]:I[Ae.facets[1].scale],ot,0);if(Ni&&Ye!=null){let Kn=A.ori==1?De:Be,ri=je(rn.dist(n,Xt,Ne,Ln,Kn));if(ri<ki){let oi=rn.bias;if(oi!=0){let Mn=Ei(Kn,Ae.scale),Ti=Ye>=0?1:-1,Sn=Mn>=0?1:-1;Sn==Ti&&(Sn==1?oi==1?Ye>=Mn:Ye<=Mn:oi==1?Ye<=Mn:Ye>=Mn)&&(ki=ri,ss=Xt)}else ki=ri,ss=Xt}}if(B||Oi){let Kn,ri;A.ori==0?(Kn=In,ri=Ln):(Kn=Ln,ri=In);let oi,Mn,Ti,Sn,bn,Vn,dr=!0,os=Te.bbox;if(os!=null){dr=!1;let jn=os(n,Xt);Ti=jn.left,Sn=jn.top,oi=jn.width,Mn=jn.height}else Ti=Kn,Sn=ri,oi=Mn=Te.size(n,Xt);if(Vn=Te.fill(n,Xt),bn=Te.stroke(n,Xt),Oi)Xt==ss&&ki<=rn.prox&&(Lt=Ti,Ot=Sn,ee=oi,Ie=Mn,ge=dr,he=Vn,ie=bn);else{let jn=Xe[Xt];jn!=null&&(Mi[Xt]=Ti,Fi[Xt]=Sn,Bf(jn,oi,Mn,dr),Of(jn,Vn,bn),Ri(jn,ti(Ti),ti(Sn),M,V))}}}}if(Oi){let Xt=rn.prox,Ae=As==null?ki<=Xt:ki>Xt||ss!=As;if(B||Ae){let We=Xe[0];Mi[0]=Lt,Fi[0]=Ot,Bf(We,ee,Ie,ge),Of(We,he,ie),Ri(We,ti(Lt),ti(Ot),M,V)}}}if(Ue.show&&ns)if(x!=null){let[ft,xt]=qe.scales,[Pt,Lt]=qe.match,[Ot,ee]=x.cursor.sync.scales,Ie=x.cursor.drag;if(an=Ie._x,ln=Ie._y,an||ln){let{left:ge,top:he,width:ie,height:Xt}=x.select,Ae=x.scales[Ot].ori,We=x.posToVal,ze,Ne,Ye,In,Ln,Kn=ft!=null&&Pt(ft,Ot),ri=xt!=null&&Lt(xt,ee);Kn&&an?(Ae==0?(ze=ge,Ne=ie):(ze=he,Ne=Xt),Ye=I[ft],In=F(We(ze,Ot),Ye,K,0),Ln=F(We(ze+Ne,Ot),Ye,K,0),ho(ei(In,Ln),je(Ln-In))):ho(0,K),ri&&ln?(Ae==1?(ze=ge,Ne=ie):(ze=he,Ne=Xt),Ye=I[xt],In=G(We(ze,ee),Ye,ot,0),Ln=G(We(ze+Ne,ee),Ye,ot,0),uo(ei(In,Ln),je(Ln-In))):uo(0,ot)}else Qo()}else{let ft=je(Hu-zu),xt=je(Gu-Vu);if(A.ori==1){let ee=ft;ft=xt,xt=ee}an=fn.x&&ft>=fn.dist,ln=fn.y&&xt>=fn.dist;let Pt=fn.uni;Pt!=null?an&&ln&&(an=ft>=Pt,ln=xt>=Pt,!an&&!ln&&(xt>ft?ln=!0:an=!0)):fn.x&&fn.y&&(an||ln)&&(an=ln=!0);let Lt,Ot;an&&(A.ori==0?(Lt=lr,Ot=De):(Lt=cr,Ot=Be),ho(ei(Lt,Ot),je(Ot-Lt)),ln||uo(0,ot)),ln&&(A.ori==1?(Lt=lr,Ot=De):(Lt=cr,Ot=Be),uo(ei(Lt,Ot),je(Ot-Lt)),an||ho(0,K)),!an&&!ln&&(ho(0,0),uo(0,0))}if(fn._x=an,fn._y=ln,x==null){if(D){if(nf!=null){let[ft,xt]=qe.scales;qe.values[0]=ft!=null?Ei(A.ori==0?De:Be,ft):null,qe.values[1]=xt!=null?Ei(A.ori==1?De:Be,xt):null}po(Cf,n,De,Be,M,V,U)}if(Ni){let ft=D&&qe.setSeries,xt=rn.prox;As==null?ki<=xt&&wi(ss,ur,!0,ft):ki>xt?wi(null,ur,!0,ft):ss!=As&&wi(ss,ur,!0,ft)}}B&&(dt.idx=U,Ol()),w!==!1&&cn("setCursor")}let rs=null;Object.defineProperty(n,"rect",{get(){return rs==null&&fo(!1),rs}});function fo(x=!1){x?rs=null:(rs=g.getBoundingClientRect(),cn("syncRect",rs))}function qu(x,w,D,U,z,K,ot){Ut._lock||ns&&x!=null&&x.movementX==0&&x.movementY==0||(Fl(x,w,D,U,z,K,ot,!1,x!=null),x!=null?Cs(null,!0,!0):Cs(w,!0,!1))}function Fl(x,w,D,U,z,K,ot,ft,xt){if(rs==null&&fo(!1),ce(x),x!=null)D=x.clientX-rs.left,U=x.clientY-rs.top;else{if(D<0||U<0){De=-10,Be=-10;return}let[Pt,Lt]=qe.scales,Ot=w.cursor.sync,[ee,Ie]=Ot.values,[ge,he]=Ot.scales,[ie,Xt]=qe.match,Ae=w.axes[0].side%2==1,We=A.ori==0?M:V,ze=A.ori==1?M:V,Ne=Ae?K:z,Ye=Ae?z:K,In=Ae?U:D,Ln=Ae?D:U;if(ge!=null?D=ie(Pt,ge)?l(ee,I[Pt],We,0):-10:D=We*(In/Ne),he!=null?U=Xt(Lt,he)?l(Ie,I[Lt],ze,0):-10:U=ze*(Ln/Ye),A.ori==1){let Kn=D;D=U,U=Kn}}xt&&((D<=1||D>=M-1)&&(D=Ds(D,M)),(U<=1||U>=V-1)&&(U=Ds(U,V))),ft?(zu=D,Vu=U,[lr,cr]=Ut.move(n,D,U)):(De=D,Be=U)}let Bl={width:0,height:0,left:0,top:0};function Qo(){jo(Bl,!1)}let Yu,$u,Zu,Ju;function Ku(x,w,D,U,z,K,ot){ns=!0,an=ln=fn._x=fn._y=!1,Fl(x,w,D,U,z,K,ot,!0,!1),x!=null&&(Dt(Ql,sc,ju,!1),po(Rf,n,lr,cr,M,V,null));let{left:ft,top:xt,width:Pt,height:Lt}=Ue;Yu=ft,$u=xt,Zu=Pt,Ju=Lt,Qo()}function ju(x,w,D,U,z,K,ot){ns=fn._x=fn._y=!1,Fl(x,w,D,U,z,K,ot,!1,!0);let{left:ft,top:xt,width:Pt,height:Lt}=Ue,Ot=Pt>0||Lt>0,ee=Yu!=ft||$u!=xt||Zu!=Pt||Ju!=Lt;if(Ot&&ee&&jo(Ue),fn.setScale&&Ot&&ee){let Ie=ft,ge=Pt,he=xt,ie=Lt;if(A.ori==1&&(Ie=xt,ge=Lt,he=ft,ie=Pt),an&&is(R,Ei(Ie,R),Ei(Ie+ge,R)),ln)for(let Xt in I){let Ae=I[Xt];Xt!=R&&Ae.from==null&&Ae.min!=de&&is(Xt,Ei(he+ie,Xt),Ei(he,Xt))}Qo()}else Ut.lock&&(Ut._lock=!Ut._lock,Cs(null,!0,!1));x!=null&&(me(Ql,sc),po(Ql,n,De,Be,M,V,null))}function rg(x,w,D,U,z,K,ot){if(Ut._lock)return;ce(x);let ft=ns;if(ns){let xt=!0,Pt=!0,Lt=10,Ot,ee;A.ori==0?(Ot=an,ee=ln):(Ot=ln,ee=an),Ot&&ee&&(xt=De<=Lt||De>=M-Lt,Pt=Be<=Lt||Be>=V-Lt),Ot&&xt&&(De=De<lr?0:M),ee&&Pt&&(Be=Be<cr?0:V),Cs(null,!0,!0),ns=!1}De=-10,Be=-10,Cs(null,!0,!0),ft&&(ns=ft)}function Qu(x,w,D,U,z,K,ot){Ut._lock||(ce(x),Ht(),Qo(),x!=null&&po(Lf,n,De,Be,M,V,null))}function tf(){y.forEach(m_),St(n.width,n.height,!0)}Os(da,yr,tf);let fr={};fr.mousedown=Ku,fr.mousemove=qu,fr.mouseup=ju,fr.dblclick=Qu,fr.setSeries=(x,w,D,U)=>{let z=qe.match[2];D=z(n,w,D),D!=-1&&wi(D,U,!0,!1)},Ut.show&&(Dt(Rf,g,Ku),Dt(Cf,g,qu),Dt(Pf,g,x=>{ce(x),fo(!1)}),Dt(If,g,rg),Dt(Lf,g,Qu),fc.add(n),n.syncRect=fo);let ta=n.hooks=i.hooks||{};function cn(x,w,D){Ll?co.push([x,w,D]):x in ta&&ta[x].forEach(U=>{U.call(null,n,w,D)})}(i.plugins||[]).forEach(x=>{for(let w in x.hooks)ta[w]=(ta[w]||[]).concat(x.hooks[w])});let ef=(x,w,D)=>D,qe=Ze({key:null,setSeries:!1,filters:{pub:Gf,sub:Gf},scales:[R,v[1]?v[1].scale:null],match:[Wf,Wf,ef],values:[null,null]},Ut.sync);qe.match.length==2&&qe.match.push(ef),Ut.sync=qe;let nf=qe.key,kl=Od(nf);function po(x,w,D,U,z,K,ot){qe.filters.pub(x,w,D,U,z,K,ot)&&kl.pub(x,w,D,U,z,K,ot)}kl.sub(n);function og(x,w,D,U,z,K,ot){qe.filters.sub(x,w,D,U,z,K,ot)&&fr[x](null,w,D,U,z,K,ot)}n.pub=og;function ag(){kl.unsub(n),fc.delete(n),$t.clear(),ac(da,yr,tf),u.remove(),ht?.remove(),cn("destroy")}n.destroy=ag;function zl(){cn("init",i,t),Et(t||i.data,!1),$[R]?Dl(R,$[R]):Ht(),Me=Ue.show&&(Ue.width>0||Ue.height>0),jt=B=!0,St(i.width,i.height)}return v.forEach(bs),y.forEach($o),e?e instanceof HTMLElement?(e.appendChild(u),zl()):e(n,zl):zl(),n}dn.assign=Ze;dn.fmtNum=yc;dn.rangeNum=pa;dn.rangeLog=ga;dn.rangeAsinh=_c;dn.orient=Bs;dn.pxRatio=Se;dn.join=o0;dn.fmtDate=Mc,dn.tzDate=_0;dn.sync=Od;{dn.addGap=Q0,dn.clipGaps=ya;let i=dn.paths={points:Hd};i.linear=Wd,i.stepped=n_,i.bars=i_,i.spline=r_}var $d='.uplot, .uplot *, .uplot *::before, .uplot *::after {box-sizing: border-box;}.uplot {font-family: system-ui, -apple-system, "Segoe UI", Roboto, "Helvetica Neue", Arial, "Noto Sans", sans-serif, "Apple Color Emoji", "Segoe UI Emoji", "Segoe UI Symbol", "Noto Color Emoji";line-height: 1.5;width: min-content;}.u-title {text-align: center;font-size: 18px;font-weight: bold;}.u-wrap {position: relative;user-select: none;}.u-over, .u-under {position: absolute;}.u-under {overflow: hidden;}.uplot canvas {display: block;position: relative;width: 100%;height: 100%;}.u-axis {position: absolute;}.u-legend {font-size: 14px;margin: auto;text-align: center;}.u-inline {display: block;}.u-inline * {display: inline-block;}.u-inline tr {margin-right: 16px;}.u-legend th {font-weight: 600;}.u-legend th > * {vertical-align: middle;display: inline-block;}.u-legend .u-marker {width: 1em;height: 1em;margin-right: 4px;background-clip: padding-box !important;}.u-inline.u-live th::after {content: ":";vertical-align: middle;}.u-inline:not(.u-live) .u-value {display: none;}.u-series > * {padding: 4px;}.u-series th {cursor: pointer;}.u-legend .u-off > * {opacity: 0.3;}.u-select {background: rgba(0,0,0,0.07);position: absolute;pointer-events: none;}.u-cursor-x, .u-cursor-y {position: absolute;left: 0;top: 0;pointer-events: none;will-change: transform;}.u-hz .u-cursor-x, .u-vt .u-cursor-y {height: 100%;border-right: 1px dashed #607D8B;}.u-hz .u-cursor-y, .u-vt .u-cursor-x {width: 100%;border-bottom: 1px dashed #607D8B;}.u-cursor-pt {position: absolute;top: 0;left: 0;border-radius: 50%;border: 0 solid;pointer-events: none;will-change: transform;/*this has to be !important since we set inline "background" shorthand */background-clip: padding-box !important;}.u-axis.u-off, .u-select.u-off, .u-cursor-x.u-off, .u-cursor-y.u-off, .u-cursor-pt.u-off {display: none;}';document.head.append(q("style",{},$d));document.head.append(q("style",{},".uplot,.u-legend{font:12px system-ui;color:inherit} .u-legend{text-align:left} .u-legend .u-marker{width:10px;height:3px}"));var Zd=170;function Cc(i){let t={stroke:Dn("soft"),grid:{stroke:Dn("line"),width:1},ticks:{stroke:Dn("line"),width:1},font:"11px system-ui"};return[{...t,size:26},{...t,size:52,values:(e,n)=>n.map(s=>`${+s.toPrecision(6)}`),label:i,labelSize:16,labelFont:"11px system-ui"}]}function Rc(i,t,e,n){let s=q("div",{class:"plot"},q("h3",{},i," ",q("small",{},t))),r=null;return new ResizeObserver(()=>{let o=s.clientWidth-20;o<50||(r?r.setSize({width:o,height:Zd}):r=new dn({width:o,height:Zd,axes:Cc(""),...e},n,s))}).observe(s),s.plot=()=>r,s}function Pc({title:i,unit:t,x:e,values:n,half:s,smoothed:r,stroke:o,trial:a,named:l},c){let u=S=>n.map((v,y)=>v===null||s[y]===null||s[y]===void 0?null:v+S*s[y]),f={label:"found",stroke:o,width:1.5,points:{show:n.length<=60,size:4,fill:o}},h={stroke:"transparent",points:{show:!1}},p=[{label:""},f,{label:"95 % to",...h},{label:"from",...h}],_=[e,n,u(1),u(-1)];r&&(p.push({label:"smoothed",stroke:Dn("ink"),width:1,dash:[5,4],points:{show:!1}}),_.push(r));let g=null,m=Rc(i,t,{scales:{x:{time:!1}},axes:l?Cc("").map((S,v)=>v?S:{...S,values:(y,I)=>I.map(C=>l[C]??"")}):Cc(""),series:p,bands:[{series:[2,3],fill:__(o)}],legend:{show:!!r},cursor:{sync:{key:`trial${a}`},drag:{x:!0,y:!1}},hooks:{draw:[S=>{let v=S.ctx,{left:y,top:I,width:C,height:R}=S.bbox,L=window.devicePixelRatio||1;if(e.forEach((E,b)=>{let A=gf(a,b);if(A==="g")return;v.fillStyle=Dn(`${Ai[A]}-mark`);let O={d:4,a:6,f:9}[A]*L;v.fillRect(S.valToPos(E,"x",!0)-L,I+R-O,2*L,O)}),Ft.trial===a){let E=S.valToPos(e[Ft.frame],"x",!0);E>=y&&E<=y+C&&(v.fillStyle=Dn("ink"),v.fillRect(E-L/2,I,L,R))}}],ready:[S=>{g=S;let v=0;S.over.addEventListener("mousedown",y=>{v=y.clientX}),S.over.addEventListener("mouseup",y=>{Math.abs(y.clientX-v)<3&&S.cursor.idx!==null&&c(S.cursor.idx)})}]}},_),d=-1;return Ci(()=>{g&&m.isConnected&&m.offsetParent&&d!==Ft.frame&&(d=Ft.frame,g.redraw(!1,!1))}),m}function __(i){let t=document.createElement("canvas").getContext("2d");t.fillStyle=i;let[e,n,s]=[1,3,5].map(r=>parseInt(t.fillStyle.slice(r,r+2),16));return`rgba(${e},${n},${s},.28)`}function Jd(i,t,e){let n=[...new Set(t.flatMap(a=>a.chain.map(l=>l.s)))].sort((a,l)=>a-l),s=new Map(n.map((a,l)=>[a,l])),r=t.map(()=>new Array(n.length).fill(void 0)),o=t.map((a,l)=>{let c=new Array(n.length).fill(void 0);for(let{s:u,point:f}of a.chain)c[s.get(u)]=f&&!Number.isNaN(f.residual)?f.residual:null,r[l][s.get(u)]=f;return c});return Rc(i,"px, outside positive",{scales:{x:{time:!1},y:{range:(a,l,c)=>{let u=Math.max(1,Math.abs(l??0),Math.abs(c??0));return[-u,u]}}},series:[{label:"px along"},...t.map(a=>({label:a.name,stroke:a.colour,width:1.2,points:{show:!1}}))],legend:{show:t.length>1},hooks:{setCursor:[a=>{let l=a.cursor.idx,c=l==null?null:r.map(u=>u[l]).find(Boolean);e(c??null)}]}},[n,...o])}function Kd(i,t){return Rc(i,"objective",{scales:{x:{time:!1}},series:[{label:"step"},{label:"objective",stroke:Dn("focus"),width:1.5}]},[t.map((e,n)=>n),t])}var ui={edges:!1,residuals:!1,hidden:new Set,path:!0};function jd(i,t){let e=q("div"),n=q("select",{"aria-label":"trial",onchange:()=>gr(+n.value,0)},gt.trials.map((A,O)=>q("option",{value:O},A.name))),s=q("input",{type:"range",class:"grow",min:0,"aria-label":"frame",oninput:()=>li(Ft.trial,+s.value)}),r=q("button",{type:"button",title:"space",onclick:()=>Is(!Ft.playing,y)},"play"),o=q("b"),a=q("span",{class:"bar",style:"margin:0"}),l=A=>q("label",{},`${A} `,q("input",{type:"range",class:"narrow",min:20,max:300,value:100,oninput:O=>{cs.look[A]=+O.target.value,R()}})),c=q("div",{class:"views"}),u=q("div",{class:"note",hidden:!0}),f=q("div",{class:"panel"}),h=q("div",{class:"plots"});i.append(q("div",{class:"bar"},gt.trials.length>1?n:null,r,v("‹",-1,"left"),o,v("›",1,"right"),s),q("div",{class:"bar"},a,Rs("edges",ui.edges,A=>{ui.edges=A,R()}),Rs("residuals",ui.residuals,A=>{ui.residuals=A,R()}),l("brightness"),l("contrast"),q("span",{class:"soft"},"wheel: zoom · drag: move · ",q("kbd",{},"←")," ",q("kbd",{},"→")," frame · ",q("kbd",{},"space")," play")),u,c,f,h,q("div",{class:"panel"},e,Jl()));let p=[],_=null,g=null,m=-1,d=0,S=null;function v(A,O,F){return q("button",{type:"button",title:`${F} arrow`,onclick:()=>li(Ft.trial,Ft.frame+O)},A)}let y=()=>_?.trial===Ft.trial&&_?.frame===Ft.frame;function I(){m=Ft.trial;let A=gt.trials[Ft.trial];s.max=A.frames.length-1,n.value=Ft.trial,e.replaceChildren(...Zl(Ft.trial,gr)),ui.hidden.clear(),a.replaceChildren(...A.bodies.map((O,F)=>{let G=Rs(gt.bodies[O].name,!0,$=>{ui.hidden[$?"delete":"add"](F),R()});return G.insertBefore(q("i",{class:"c",style:`background:${A.colours[F]}`}),G.lastChild),G})),p=A.views.map(()=>new cs(q("div"))),c.replaceChildren(...p.map(O=>O.host)),c.style.setProperty("--columns",Math.min(3,p.length))}async function C(){if(r.textContent=Ft.playing?"pause":"play",!t())return;m!==Ft.trial&&I();let{trial:A,frame:O}=Ft;s.value=O;let F=gt.trials[A];o.textContent=`${F.frames[O]}${F.times.length?` · ${F.times[O].toFixed(3)} s`:""}`;let G=++d;try{let $=await ls(A,O);if(gt.searches.some(W=>W.trial===A&&W.frame===O)&&(S=await mr().catch(()=>null)),G!==d)return;u.hidden=!0,c.hidden=!1,_={trial:A,frame:O,...$},g=null,R(),Ft.playing||b(),O+1<F.frames.length&&ls(A,O+1).catch(()=>{})}catch($){if(G!==d)return;_={trial:A,frame:O,views:[]},u.hidden=!1,c.hidden=!0,u.textContent=$.message,f.replaceChildren(),h.replaceChildren()}}function R(){if(!_)return;let A=gt.trials[_.trial];p.forEach((O,F)=>{let G=_.views.find(Z=>Z.slot===F),$=gt.views[A.views[F]].name;if(O.tag.replaceChildren(q("b",{},$)),!G){O.tag.append(`
this picture could not be used`);return}let W=G.outlines.filter(Z=>!ui.hidden.has(Z.place));for(let{place:Z}of W){let J=A.rows[Z],[ct,lt]=[J.rms_px[_.frame]?.[F],J.share[_.frame]?.[F]];O.tag.append(`
${gt.bodies[A.bodies[Z]].name}: ${$e(ct,2)} px, ${$e(100*lt,0)} % found`)}O.show(G,(Z,J)=>{ui.edges&&aa(Z,G.edges,J);for(let{place:ct,points:lt}of W)bf(Z,lt,J,{colour:A.colours[ct],failed:oa(_.trial,ct,_.frame)==="f",residuals:ui.residuals});ui.path&&E(Z,J,F),g&&g.slot===F&&(Z.fillStyle="#fff",Z.beginPath(),Z.arc(g.point.x,g.point.y,4*J,0,7),Z.fill())})})}let L=()=>gt.searches.filter(A=>A.trial===_.trial&&A.frame===_.frame&&!ui.hidden.has(A.place));function E(A,O,F){if(S)for(let{place:G,steps:$}of L()){let W=gt.trials[_.trial],Z=S.get(W.bodies[G]);if(!Z)continue;[...new Set([0,1,2,3,4].map(ct=>Math.round(ct/5*($.length-1))))].forEach((ct,lt)=>{let[,{translation_mm:_t,quaternion_wxyz:dt}]=$[ct];la(A,sa(Z,as([..._t,...dt],Z.centroid),gt.views[W.views[F]]),O,`rgba(255,255,255,${.35+.1*lt})`)})}}function b(){let A=gt.trials[_.trial];f.replaceChildren(q("table",{},q("tbody",{},A.rows.map((O,F)=>{let G=O.half_95[_.frame];return q("tr",{},q("td",{class:"t"},q("i",{class:"c",style:`background:${A.colours[F]}`}),gt.bodies[A.bodies[F]].name),q("td",{class:"t"},Ls(O.verdicts[_.frame])),q("td",{},O.fit_mm[_.frame]===null?"":`fit ${$e(O.fit_mm[_.frame],3)} mm`),q("td",{},G?`95 %: ± ${G.slice(0,3).map($=>$e($,2)).join(" / ")} mm, ± ${G.slice(3).map($=>$e($,2)).join(" / ")}°`:""),q("td",{class:"reason"},[O.reasons[_.frame],O.look[_.frame],O.edited.includes(_.frame)?"edited by hand":""].filter(Boolean).join("; ")),q("td",{},q("a",{href:`#review/${encodeURIComponent(A.name)}/${encodeURIComponent(A.frames[_.frame])}/${F}`},"put right")))})))),h.replaceChildren(..._.views.map(O=>Jd(`Residual along the outline, view ${gt.views[A.views[O.slot]].name}`,O.outlines.map(F=>({name:gt.bodies[A.bodies[F.place]].name,colour:A.colours[F.place],chain:wf(F.points)})),F=>{g=F&&{slot:O.slot,point:F},R()})),...L().map(O=>Kd(`Search of ${gt.bodies[A.bodies[O.place]].name}`,O.steps.map(([F])=>F))))}return Ci(C),{show:C,ready:y,pictures:()=>p,current:()=>_}}var Qd=["x","y","z"];function x_(i,t){let{rows:e,bodies:n}=gt.trials[i],s=e[t],r=gt.bodies[n[t]].centroid??[0,0,0],o=s.poses.map((m,d)=>m&&s.verdicts[d]!=="f"?m:null),a=o.findIndex((m,d)=>m&&s.verdicts[d]==="g"),l=o[a>=0?a:o.findIndex(Boolean)],c=m=>m.map(d=>d&&hn(d.slice(0,3),wn(go(d.slice(3)),r))),u=m=>m.map(d=>d&&sf(Vl(d.slice(3),rf(l.slice(3)))).map(S=>S*180/Math.PI)),[f,h]=[c(o),u(o)],[p,_]=s.smoothed&&l?[c(s.smoothed),u(s.smoothed)]:[null,null],g=m=>s.half_95.map((d,S)=>d&&o[S]?d[m]:null);return[...Qd.map((m,d)=>({title:`${m}`,unit:"mm, centroid",values:f.map(S=>S&&S[d]),half:g(d),smoothed:p?.map(S=>S&&S[d])})),...Qd.map((m,d)=>({title:`rotation ${m}`,unit:"°, since the first good frame",values:h.map(S=>S&&S[d]),half:g(3+d),smoothed:_?.map(S=>S&&S[d])}))]}function tp(i,t){let e=q("select",{"aria-label":"trial",onchange:()=>r(+e.value)},gt.trials.map((l,c)=>q("option",{value:c},l.name))),n=q("div");i.append(q("div",{class:"bar"},gt.trials.length>1?e:null,q("span",{class:"soft"},"click a plot: go to the frame · drag: zoom · double click: all · marks at the bottom: frames that are not good · upright line: the frame looked at")),n);let s=-1,r=l=>{Ft.trial=l,Ft.frame=0,a()},o=l=>gr(Ft.trial,l);function a(){if(!t()||s===Ft.trial)return;s=Ft.trial,e.value=Ft.trial;let l=Ft.trial,c=gt.trials[l],u=c.times.length?c.times:c.frames.map((_,g)=>g),f=c.times.length?null:c.frames,h=c.joints.map(_=>q("div",{},q("h2",{},_.name),q("div",{class:"plots"},_.quantities.map(g=>Pc({title:g.label,unit:g.unit,x:u,values:g.values,half:g.half_width_95,smoothed:g.smoothed,stroke:"#2f7ed8",trial:l,named:f},o))))),p=c.bodies.map((_,g)=>q("div",{},q("h2",{},gt.bodies[_].name),q("div",{class:"plots"},x_(l,g).map(m=>Pc({...m,x:u,stroke:c.colours[g],trial:l,named:f},o)))));n.replaceChildren(...h,...p,q("p",{class:"soft"},`Over ${c.times.length?"time in s":"frames"}. Axes are those of the laboratory. Bands hold the truth with 95 % by what residuals and, where known, the calibration say; failed poses are left out. Rotations are one rotation vector, not three successive turns.`))}return Ci(a),{show:a}}var Ic="trial,frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz",ep=`biplane-review-${gt.name}`,Lc=class{constructor(){this.rows=new Map,this.odd=[]}set(t,e,n,s){let r=[...s.slice(0,3).map(o=>o.toFixed(4)),...s.slice(3).map(o=>o.toFixed(7))];this.rows.set([t,e,n].join("\0"),[...[t,e,n].map(np),...r].join(","))}delete(t,e,n){this.rows.delete([t,e,n].join("\0"))}has(t,e,n){return this.rows.has([t,e,n].join("\0"))}merge(t){let e=t.split(/\r?\n/).filter(o=>o.trim()),n=ip(e[0]??"").map(o=>o.trim()),s=Ic.split(",").map(o=>n.indexOf(o));if(s.some(o=>o<0))throw new Error(`the first line of the file is not ${Ic}`);let r=0;for(let o of e.slice(1)){let a=ip(o),l=s.map(u=>a[u]??""),c=l.slice(0,3).join("\0");this.rows.has(c)||(this.rows.set(c,[...l.slice(0,3).map(np),...l.slice(3)].join(",")),r++)}return r}text(){return`${[Ic,...[...this.rows.values()].sort()].join(`
`)}
`}},np=i=>/[",\n]/.test(i)?`"${i.replaceAll('"','""')}"`:i;function ip(i){let t=[],e=/("([^"]|"")*"|[^,]*)(,|$)/gy;for(let n=e.exec(i);n&&(t.push(n[1].startsWith('"')?n[1].slice(1,-1).replaceAll('""','"'):n[1]),!!n[3]);n=e.exec(i));return t}function sp(i,t){let e=new Lc;for(let j of gt.trials)j.rows.forEach((st,It)=>Object.entries(st.edits).forEach(([yt,Zt])=>e.set(j.name,j.frames[yt],gt.bodies[j.bodies[It]].name,Zt)));let n=e.rows.size;try{e.rows=new Map([...e.rows,...JSON.parse(sessionStorage.getItem(ep)??"[]")])}catch{}let s=q("div",{class:"queue"}),r=q("div",{class:"bar"}),o=q("div",{class:"views",style:"--height:calc(100vh - 372px)"}),a=q("span",{class:"live"}),l=q("div",{class:"note"},"Choose a pose on the left."),c=q("textarea",{readonly:!0,"aria-label":"edits/poses.csv",spellcheck:"false"}),u=q("span",{class:"soft"}),f=(j,st,It,yt)=>q("button",{type:"button",onclick:st,title:It,class:yt},j),h={undo:f("undo",()=>J(-1),"Ctrl Z"),redo:f("redo",()=>J(1),"Ctrl Y"),reset:f("as found",ct,"the pose of the last run"),other:f("the other pose",lt,"the pose that fits as well"),take:f("take this pose",Yt,"Enter: into the table below, and to the next","main"),drop:f("take it back",Q,"out of the table below")},p=q("input",{type:"file",accept:".csv",hidden:!0,onchange:pt}),_=Kl().filter(({trial:j,frame:st})=>Xl(j,st));i.append(q("div",{class:"review"},s,q("div",{},r,l,o,q("div",{class:"bar"},h.take,h.drop,h.undo,h.redo,h.reset,h.other,a),q("p",{class:"soft"},"drag: move · right or ",q("kbd",{},"Ctrl")," drag: turn · ",q("kbd",{},"Alt")," drag: turn in the picture · ",q("kbd",{},"Shift")," drag up or down, or ",q("kbd",{},"Shift")," wheel: depth · wheel: zoom · middle drag: move the picture · arrows, ",q("kbd",{},"PgUp")," ",q("kbd",{},"PgDn"),": small steps"),q("div",{class:"panel"},q("div",{class:"bar"},q("b",{},"edits/poses.csv"),f("save",ht,"a file","main"),f("copy",Bt),f("merge a file…",()=>p.click(),"rows of edits/poses.csv that are not here yet"),p,u),c,q("p",{class:"soft"},"Put the file into the folder ",q("code",{},"edits/")," beside pipeline.toml, in place of the one there, and run again: those matches start from these poses, and nothing else runs.")))));let g=null,m=[],S=_.slice(0,300);function v(){let j=st=>{let It=gt.trials[st.trial],yt=It.rows[st.place],Zt=gt.bodies[It.bodies[st.place]].name,N=e.has(It.name,It.frames[st.frame],Zt);return q("button",{type:"button",onclick:()=>C(st),"aria-current":g&&y(g.item,st)?"true":null},Ls(yt.verdicts[st.frame]),` ${It.frames[st.frame]} `,N?"✓":"",q("small",{},`${Zt} · ${yt.rms_px[st.frame]?`${$e(Math.max(...yt.rms_px[st.frame]),2)} px`:"no match"}`),q("small",{},yt.reasons[st.frame]??""))};s.replaceChildren(...S.map(j)),c.value=e.text()}let y=(j,st)=>j.trial===st.trial&&j.frame===st.frame&&j.place===st.place,I=null;async function C(j){if(I&&y(I,j))return;I=j;let st=gt.trials[j.trial],It=st.bodies[j.place],yt=gt.bodies[It].name;try{let[Zt,N]=await Promise.all([ls(j.trial,j.frame),mr()]);if(I!==j)return;let le=N.get(It);if(!le)throw new Error(`The model of ${yt} is not shown; the overview says why.`);let Qt=st.rows[j.place],$t=Qt.poses[j.frame],Dt=$t?as($t,le.centroid):{q:[1,0,0,0],at:y_(st.views.map(Tt=>gt.views[Tt]))},me=Zt.views.map(Tt=>({slot:Tt.slot,picture:Tt,camera:gt.views[st.views[Tt.slot]],index:of(Tt.edges,j.place),inset:Tt.outlines.find(P=>P.place===j.place)?.inset??0}));g={item:j,name:yt,mesh:le,found:Dt,pose:Dt,past:[Dt],at:0,views:me,alternative:Qt.alternatives[j.frame]},l.hidden=!0,R()}catch(Zt){if(I!==j)return;l.hidden=!1,l.textContent=Zt.message}I===j&&(I=null)}function R(){let{item:j,name:st,views:It}=g,yt=gt.trials[j.trial];r.replaceChildren(q("h3",{},`${yt.name} · ${yt.frames[j.frame]} · ${st}`),Ls(yt.rows[j.place].verdicts[j.frame]),q("span",{class:"soft"},yt.rows[j.place].reasons[j.frame]??"")),m=It.map(Zt=>{let N=new cs(q("div"));return N.grab=le=>E(Zt,le),N.released=Z,N.turnWheel=le=>le.shiftKey?(W(G(Zt,-(le.deltaY||le.deltaX)*.02)),Z(),!0):!1,N.canvas.addEventListener("keydown",le=>$(Zt,le)),N}),o.replaceChildren(...m.map(Zt=>Zt.host)),o.style.setProperty("--columns",Math.min(3,m.length)),v(),L()}function L(){let{item:j,mesh:st,views:It}=g,yt=gt.trials[j.trial],Zt=It.map((N,le)=>{let Qt=sa(st,g.pose,N.camera),$t=af(Qt,N.index,{size:N.picture.size,inset:N.inset,bright:gt.contrast_bright});N.how=$t;let Dt=m[le];return N.first??=$t,Dt.tag.replaceChildren(q("b",{},N.camera.name),`
${$e($t.rms,2)} px, ${$e(100*$t.share,0)} % found`,`
as found: ${$e(N.first.rms,2)} px, ${$e(100*N.first.share,0)} %`),Dt.show(N.picture,(me,Tt)=>{aa(me,N.picture.edges.filter(P=>!P.bodies||P.bodies.includes(j.place)),Tt),la(me,Qt,Tt,yt.colours[j.place],$t.residuals)}),`${N.camera.name}: ${$e($t.rms,2)} px, ${$e(100*$t.share,0)} %`});a.textContent=Zt.join("   "),h.undo.disabled=g.at===0,h.redo.disabled=g.at===g.past.length-1,h.other.hidden=!g.alternative,h.drop.hidden=!e.has(yt.name,yt.frames[j.frame],g.name)}function E(j,st){let It=st.button===2||st.ctrlKey||st.metaKey,yt=st.altKey?"spin":st.shiftKey?"depth":It?"turn":"move";return Zt=>W({move:A,turn:O,spin:F,depth:(N,le)=>G(N,-le[1]*.5)}[yt](j,Zt))}let b=j=>xo(j.camera,g.pose.at)[2];function A(j,[st,It]){let yt=b(j);return _o(g.pose,wn(j.camera.inverse,[st*yt,It*yt,0]),[0,0,0])}function O(j,[st,It]){let yt=b(j),Zt=wn(j.camera.inverse,[st*yt,It*yt,0]),N=Gn(Hn(g.pose.at,j.camera.source));return _o(g.pose,[0,0,0],Ve(na(Zt,N),.5/g.mesh.radius))}function F(j,[st]){return _o(g.pose,[0,0,0],Ve(Gn(Hn(g.pose.at,j.camera.source)),st*.005))}function G(j,st){return _o(g.pose,Ve(Gn(Hn(g.pose.at,j.camera.source)),st),[0,0,0])}function $(j,st){if(!g)return;let It={ArrowLeft:[-.5,0],ArrowRight:[.5,0],ArrowUp:[0,-.5],ArrowDown:[0,.5]}[st.key];if(It)W(st.ctrlKey?O(j,Ve(It,2)):A(j,It));else if(st.key==="PageUp"||st.key==="PageDown")W(G(j,st.key==="PageUp"?.5:-.5));else return;st.preventDefault(),st.stopPropagation(),Z()}function W(j){g.pose=j,L()}function Z(){!g||g.past[g.at]===g.pose||(g.past=[...g.past.slice(0,g.at+1),g.pose],g.at=g.past.length-1,L())}function J(j){g&&(g.at=Math.max(0,Math.min(g.past.length-1,g.at+j)),W(g.past[g.at]))}function ct(){g&&(W(g.found),Z())}function lt(){g?.alternative&&(W(as(g.alternative,g.mesh.centroid)),Z())}let _t=()=>{let j=gt.trials[g.item.trial];return[j.name,j.frames[g.item.frame],g.name]};function dt(){try{sessionStorage.setItem(ep,JSON.stringify([...e.rows]))}catch{}}function Yt(){if(!g)return;e.set(..._t(),ia(g.pose,g.mesh.centroid)),dt(),u.textContent=`${e.rows.size} poses${n?`, ${n} of them there before`:""}; not saved yet`;let j=S[S.findIndex(st=>y(st,g.item))+1];v(),L(),j&&gt.trials[j.trial].rows[j.place].verdicts[j.frame]!=="g"&&C(j)}function Q(){e.delete(..._t()),dt(),v(),L()}async function ht(){let j=e.text();try{if(window.showSaveFilePicker){let yt=await(await window.showSaveFilePicker({suggestedName:"poses.csv",types:[{accept:{"text/csv":[".csv"]}}]})).createWritable();await yt.write(j),await yt.close(),u.textContent="saved; run again to start from these poses";return}}catch(It){if(It.name==="AbortError")return}let st=q("a",{href:URL.createObjectURL(new Blob([j],{type:"text/csv"})),download:"poses.csv"});st.click(),setTimeout(()=>URL.revokeObjectURL(st.href),1e4),u.textContent="saved with the downloads; put it into edits/ beside pipeline.toml"}async function Bt(){c.select();try{await navigator.clipboard.writeText(e.text()),u.textContent="copied"}catch{u.textContent=document.execCommand("copy")?"copied":"select the text and copy it"}}async function pt(){let[j]=p.files;if(j){try{u.textContent=`${e.merge(await j.text())} poses added from ${j.name}`}catch(st){u.textContent=`${j.name}: ${st.message}`}p.value="",dt(),v()}}document.addEventListener("keydown",j=>{if(!t()||!g||j.target===c)return;let st=j.key.toLowerCase();(j.ctrlKey||j.metaKey)&&st==="z"&&(J(j.shiftKey?1:-1),j.preventDefault()),(j.ctrlKey||j.metaKey)&&st==="y"&&(J(1),j.preventDefault()),st==="enter"&&j.target.tagName!=="BUTTON"&&(Yt(),j.preventDefault())});function zt(){if(!t())return;s.childElementCount||v();let[,j,st,It]=location.hash.slice(1).split("/").map(decodeURIComponent),yt=gt.trials.findIndex(N=>N.name===j),Zt=yt<0?-1:gt.trials[yt].frames.indexOf(st);if(Zt>=0){let N={trial:yt,frame:Zt,place:Math.max(0,Math.min(gt.trials[yt].rows.length-1,+It||0))};if(S.some(le=>y(le,N))||S.unshift(N),!g||!y(g.item,N))return C(N)}else if(!g&&S.length)return C(S[0])}return{show:zt,current:()=>g,table:e,pictures:()=>m,live:a,take:Yt,step:J,draw:L}}function y_(i){let[t,e]=[[0,0,0],0];for(let n of i){let s=Gn(wn(n.inverse,[(n.size[0]-1)/2,(n.size[1]-1)/2,1]));for(let r of i){if(n===r)continue;let o=Gn(wn(r.inverse,[(r.size[0]-1)/2,(r.size[1]-1)/2,1])),a=na(o,na(s,o)),l=a.reduce((c,u,f)=>c+u*(r.source[f]-n.source[f]),0)/a.reduce((c,u,f)=>c+u*s[f],0);Number.isFinite(l)&&(t=hn(t,hn(n.source,Ve(s,l))),e++)}if(!e&&i.length===1)return hn(n.source,Ve(s,n.detector_mm?n.detector_mm*.75:700))}return Ve(t,1/Math.max(1,e))}var v_=i=>new Promise(t=>{setTimeout(t,i)});async function fi(i,t){for(let e=0;e<400;e++){if(await t())return;await v_(25)}throw new Error(`${i}: waited in vain`)}function tn(i,t,e=""){if(!t)throw new Error(`${i}${e===""?"":`: ${e}`}`)}function ba(i){let{data:t}=i.getContext("2d").getImageData(0,0,i.width,i.height),[e,n]=[0,0];for(let s=0;s<t.length;s+=4){let[r,o,a]=[t[s],t[s+1],t[s+2]];Math.max(r,o,a)-Math.min(r,o,a)>60&&e++,r+o+a>60&&n++}return{coloured:e,lit:n}}var Dc=(i,t,e,n,s={})=>i.dispatchEvent(new PointerEvent(t,{bubbles:!0,pointerId:7,clientX:e,clientY:n,...s}));async function rp(i,t){let e=[],n={async"the overview has a strip a body and a row a pose"(){t("overview");let o=gt.trials.reduce((a,l)=>a+l.bodies.length,0);await fi("strips",()=>[...document.querySelectorAll("#strips canvas")].every(a=>a.width>50&&ba(a).coloured>20)),tn("strips",document.querySelectorAll("#strips canvas").length===o),tn("rows",document.querySelectorAll("#table tbody tr").length===Math.min(200,gt.trials.reduce((a,l)=>a+l.bodies.length*l.frames.length,0)))},async"a click on a strip shows that frame"(){let o=gt.trials[0],a=Math.floor(o.frames.length/2),l=document.querySelector("#strips canvas"),c=l.getBoundingClientRect();l.dispatchEvent(new MouseEvent("click",{bubbles:!0,clientX:c.left+(a+.5)/o.frames.length*c.width,clientY:c.top+5}));let u=Math.ceil(o.frames.length/c.width);await fi("the address",()=>location.hash.startsWith(`#frame/${o.name}/`)&&Math.abs(Ft.frame-a)<=(u>1?u:0)),await fi("the frame",()=>i.frame.ready()&&i.frame.current().views.length),tn("frame",location.hash===`#frame/${o.name}/${o.frames[Ft.frame]}`&&document.querySelector("#frame b").textContent.startsWith(o.frames[Ft.frame]));let f=i.frame.pictures().map(h=>ba(h.canvas));tn("pictures with outlines",f.length===o.views.length&&f.every(h=>h.coloured>100&&h.lit>5e3),JSON.stringify(f)),await fi("plots",()=>document.querySelectorAll("#frame .plot canvas").length===o.views.length)},async"keys go through the trial and play plays it"(){let o=gt.trials[0].frames.length,a=Ft.frame;if(document.dispatchEvent(new KeyboardEvent("keydown",{key:"ArrowLeft",bubbles:!0})),tn("left",Ft.frame===Math.max(0,a-1)),o<2)return;let l=Ft.frame;document.querySelector("#frame button").click(),tn("playing",Ft.playing),await fi("the next frame",()=>Ft.frame!==l),document.querySelector("#frame button").click(),tn("stopped",!Ft.playing)},async"zoom and residuals change the picture"(){await fi("the frame",()=>i.frame.ready());let[o]=i.frame.pictures(),a=o.scale;o.canvas.dispatchEvent(new WheelEvent("wheel",{deltaY:-400,bubbles:!0,cancelable:!0})),tn("zoomed",o.scale>1.5*a),o.fit(),tn("whole again",Math.abs(o.scale-a)<1e-9);let l=o.canvas.toDataURL();[...document.querySelectorAll("#frame label")].find(c=>c.textContent==="residuals").querySelector("input").click(),tn("residuals are drawn",o.canvas.toDataURL()!==l)},async"kinematics has six plots a body"(){t("kinematics");let o=gt.trials[Ft.trial],a=6*o.bodies.length+o.joints.reduce((l,c)=>l+c.quantities.length,0);await fi("plots",()=>document.querySelectorAll("#kinematics .plot canvas").length===a),await fi("ink",()=>[...document.querySelectorAll("#kinematics .plot canvas")].some(l=>ba(l).coloured>50))},async"the bodies stand in space"(){t("space"),await fi("3D",()=>i.space.drawn()===Ft.frame||document.querySelector("#scene .note")),tn("3D",!document.querySelector("#scene .note"),document.querySelector("#scene .note")?.textContent);let{renderer:o}=i.space.world(),a=q("canvas",{width:o.domElement.width,height:o.domElement.height});a.getContext("2d").drawImage(o.domElement,0,0);let l=ba(a);tn("bodies in colour, pictures in grey",l.coloured>200&&l.lit>2e3,JSON.stringify(l))},async"in the review a body is dragged, turned, put back and taken"(){t("review");let{review:o}=i;await fi("a pose",()=>o.current()&&o.pictures().length),await fi("the picture",()=>o.pictures().every(L=>L.scale));let{item:a,found:l,mesh:c,name:u,views:f}=o.current(),h=()=>f.map(L=>L.how.rms),p=h();tn("residuals",p.every(L=>L<16),p.join());let[_]=o.pictures(),g=_.canvas.getBoundingClientRect(),m=[g.left+g.width/2,g.top+g.height/2],d=(L,E,b)=>{Dc(_.canvas,"pointerdown",...m,b),Dc(_.canvas,"pointermove",m[0]+L,m[1]+E,b),Dc(_.canvas,"pointerup",m[0]+L,m[1]+E,b)};d(14,9);let S=o.current().pose;tn("moved",Math.hypot(...S.at.map((L,E)=>L-l.at[E]))>.3&&String(S.q)===String(l.q)),tn("the residual is live",String(h())!==String(p),h().join()),d(20,0,{ctrlKey:!0}),tn("turned",String(o.current().pose.q)!==String(l.q)&&String(o.current().pose.at)===String(S.at)),d(0,30,{shiftKey:!0}),o.step(-1),o.step(-1),o.step(-1),tn("undone",o.current().pose===l),o.step(1);let v=ia(o.current().pose,c.centroid);o.take();let y=gt.trials[a.trial],I=o.table.text().trim().split(`
`),C=I.find(L=>L.startsWith(`${y.name},${y.frames[a.frame]},${u},`));tn("a row",I[0]==="trial,frame,body,tx_mm,ty_mm,tz_mm,qw,qx,qy,qz"&&C);let R=C.split(",").slice(3).map(Number);tn("its pose",R.length===7&&R.every((L,E)=>Math.abs(L-v[E])<1e-4)&&Math.abs(Math.hypot(...R.slice(3))-1)<1e-6,C),e.push(`row ${C}`)}},s=performance.now(),r=0;for(let[o,a]of Object.entries(n))try{await a(),e.push(`ok ${o}`)}catch(l){r++,e.push(`FAILED ${o}: ${l.message}`)}e.push(r?`selftest failed: ${r}`:"selftest passed",`ms ${Math.round(performance.now()-s)}`),document.body.prepend(q("pre",{id:"selftest-result"},e.join(`
`)))}var wu="170",er={LEFT:0,MIDDLE:1,RIGHT:2,ROTATE:0,DOLLY:1,PAN:2},nr={ROTATE:0,PAN:1,DOLLY_PAN:2,DOLLY_ROTATE:3},M_=0,op=1,S_=2;var dm=1,b_=2,Yi=3,Ms=0,Nn=1,ii=2,ys=0,Wr=1,ap=2,lp=3,cp=4,w_=5,qs=100,E_=101,T_=102,A_=103,C_=104,R_=200,P_=201,I_=202,L_=203,hh=204,uh=205,D_=206,U_=207,N_=208,O_=209,F_=210,B_=211,k_=212,z_=213,V_=214,fh=0,dh=1,ph=2,$r=3,mh=4,gh=5,_h=6,xh=7,pm=0,H_=1,G_=2,vs=0,W_=1,X_=2,q_=3,Y_=4,$_=5,Z_=6,J_=7;var mm=300,Zr=301,Jr=302,yh=303,vh=304,wl=306,Mh=1e3,Zs=1001,Sh=1002,xi=1003,K_=1004;var wa=1005;var Ii=1006,Uc=1007;var Js=1008;var ji=1009,gm=1010,_m=1011,Bo=1012,Eu=1013,Ks=1014,$i=1015,Xo=1016,Tu=1017,Au=1018,Kr=1020,xm=35902,ym=1021,vm=1022,_i=1023,Mm=1024,Sm=1025,Xr=1026,jr=1027,bm=1028,Cu=1029,wm=1030,Ru=1031;var Pu=1033,$a=33776,Za=33777,Ja=33778,Ka=33779,bh=35840,wh=35841,Eh=35842,Th=35843,Ah=36196,Ch=37492,Rh=37496,Ph=37808,Ih=37809,Lh=37810,Dh=37811,Uh=37812,Nh=37813,Oh=37814,Fh=37815,Bh=37816,kh=37817,zh=37818,Vh=37819,Hh=37820,Gh=37821,ja=36492,Wh=36494,Xh=36495,Em=36283,qh=36284,Yh=36285,$h=36286;var Qa=2300,Zh=2301,Nc=2302,hp=2400,up=2401,fp=2402;var j_=3200,Q_=3201;var Tm=0,tx=1,xs="",Un="srgb",ro="srgb-linear",El="linear",Ce="srgb";var Cr=7680;var dp=519,ex=512,nx=513,ix=514,Am=515,sx=516,rx=517,ox=518,ax=519,pp=35044;var mp="300 es",Zi=2e3,tl=2001,Qi=class{addEventListener(t,e){this._listeners===void 0&&(this._listeners={});let n=this._listeners;n[t]===void 0&&(n[t]=[]),n[t].indexOf(e)===-1&&n[t].push(e)}hasEventListener(t,e){if(this._listeners===void 0)return!1;let n=this._listeners;return n[t]!==void 0&&n[t].indexOf(e)!==-1}removeEventListener(t,e){if(this._listeners===void 0)return;let s=this._listeners[t];if(s!==void 0){let r=s.indexOf(e);r!==-1&&s.splice(r,1)}}dispatchEvent(t){if(this._listeners===void 0)return;let n=this._listeners[t.type];if(n!==void 0){t.target=this;let s=n.slice(0);for(let r=0,o=s.length;r<o;r++)s[r].call(this,t);t.target=null}}},gn=["00","01","02","03","04","05","06","07","08","09","0a","0b","0c","0d","0e","0f","10","11","12","13","14","15","16","17","18","19","1a","1b","1c","1d","1e","1f","20","21","22","23","24","25","26","27","28","29","2a","2b","2c","2d","2e","2f","30","31","32","33","34","35","36","37","38","39","3a","3b","3c","3d","3e","3f","40","41","42","43","44","45","46","47","48","49","4a","4b","4c","4d","4e","4f","50","51","52","53","54","55","56","57","58","59","5a","5b","5c","5d","5e","5f","60","61","62","63","64","65","66","67","68","69","6a","6b","6c","6d","6e","6f","70","71","72","73","74","75","76","77","78","79","7a","7b","7c","7d","7e","7f","80","81","82","83","84","85","86","87","88","89","8a","8b","8c","8d","8e","8f","90","91","92","93","94","95","96","97","98","99","9a","9b","9c","9d","9e","9f","a0","a1","a2","a3","a4","a5","a6","a7","a8","a9","aa","ab","ac","ad","ae","af","b0","b1","b2","b3","b4","b5","b6","b7","b8","b9","ba","bb","bc","bd","be","bf","c0","c1","c2","c3","c4","c5","c6","c7","c8","c9","ca","cb","cc","cd","ce","cf","d0","d1","d2","d3","d4","d5","d6","d7","d8","d9","da","db","dc","dd","de","df","e0","e1","e2","e3","e4","e5","e6","e7","e8","e9","ea","eb","ec","ed","ee","ef","f0","f1","f2","f3","f4","f5","f6","f7","f8","f9","fa","fb","fc","fd","fe","ff"],gp=1234567,No=Math.PI/180,ko=180/Math.PI;function oo(){let i=Math.random()*4294967295|0,t=Math.random()*4294967295|0,e=Math.random()*4294967295|0,n=Math.random()*4294967295|0;return(gn[i&255]+gn[i>>8&255]+gn[i>>16&255]+gn[i>>24&255]+"-"+gn[t&255]+gn[t>>8&255]+"-"+gn[t>>16&15|64]+gn[t>>24&255]+"-"+gn[e&63|128]+gn[e>>8&255]+"-"+gn[e>>16&255]+gn[e>>24&255]+gn[n&255]+gn[n>>8&255]+gn[n>>16&255]+gn[n>>24&255]).toLowerCase()}function xn(i,t,e){return Math.max(t,Math.min(e,i))}function Iu(i,t){return(i%t+t)%t}function lx(i,t,e,n,s){return n+(i-t)*(s-n)/(e-t)}function cx(i,t,e){return i!==t?(e-i)/(t-i):0}function Oo(i,t,e){return(1-e)*i+e*t}function hx(i,t,e,n){return Oo(i,t,1-Math.exp(-e*n))}function ux(i,t=1){return t-Math.abs(Iu(i,t*2)-t)}function fx(i,t,e){return i<=t?0:i>=e?1:(i=(i-t)/(e-t),i*i*(3-2*i))}function dx(i,t,e){return i<=t?0:i>=e?1:(i=(i-t)/(e-t),i*i*i*(i*(i*6-15)+10))}function px(i,t){return i+Math.floor(Math.random()*(t-i+1))}function mx(i,t){return i+Math.random()*(t-i)}function gx(i){return i*(.5-Math.random())}function _x(i){i!==void 0&&(gp=i);let t=gp+=1831565813;return t=Math.imul(t^t>>>15,t|1),t^=t+Math.imul(t^t>>>7,t|61),((t^t>>>14)>>>0)/4294967296}function xx(i){return i*No}function yx(i){return i*ko}function vx(i){return(i&i-1)===0&&i!==0}function Mx(i){return Math.pow(2,Math.ceil(Math.log(i)/Math.LN2))}function Sx(i){return Math.pow(2,Math.floor(Math.log(i)/Math.LN2))}function bx(i,t,e,n,s){let r=Math.cos,o=Math.sin,a=r(e/2),l=o(e/2),c=r((t+n)/2),u=o((t+n)/2),f=r((t-n)/2),h=o((t-n)/2),p=r((n-t)/2),_=o((n-t)/2);switch(s){case"XYX":i.set(a*u,l*f,l*h,a*c);break;case"YZY":i.set(l*h,a*u,l*f,a*c);break;case"ZXZ":i.set(l*f,l*h,a*u,a*c);break;case"XZX":i.set(a*u,l*_,l*p,a*c);break;case"YXY":i.set(l*p,a*u,l*_,a*c);break;case"ZYZ":i.set(l*_,l*p,a*u,a*c);break;default:console.warn("THREE.MathUtils: .setQuaternionFromProperEuler() encountered an unknown order: "+s)}}function Hr(i,t){switch(t.constructor){case Float32Array:return i;case Uint32Array:return i/4294967295;case Uint16Array:return i/65535;case Uint8Array:return i/255;case Int32Array:return Math.max(i/2147483647,-1);case Int16Array:return Math.max(i/32767,-1);case Int8Array:return Math.max(i/127,-1);default:throw new Error("Invalid component type.")}}function En(i,t){switch(t.constructor){case Float32Array:return i;case Uint32Array:return Math.round(i*4294967295);case Uint16Array:return Math.round(i*65535);case Uint8Array:return Math.round(i*255);case Int32Array:return Math.round(i*2147483647);case Int16Array:return Math.round(i*32767);case Int8Array:return Math.round(i*127);default:throw new Error("Invalid component type.")}}var Cm={DEG2RAD:No,RAD2DEG:ko,generateUUID:oo,clamp:xn,euclideanModulo:Iu,mapLinear:lx,inverseLerp:cx,lerp:Oo,damp:hx,pingpong:ux,smoothstep:fx,smootherstep:dx,randInt:px,randFloat:mx,randFloatSpread:gx,seededRandom:_x,degToRad:xx,radToDeg:yx,isPowerOfTwo:vx,ceilPowerOfTwo:Mx,floorPowerOfTwo:Sx,setQuaternionFromProperEuler:bx,normalize:En,denormalize:Hr},se=class i{constructor(t=0,e=0){i.prototype.isVector2=!0,this.x=t,this.y=e}get width(){return this.x}set width(t){this.x=t}get height(){return this.y}set height(t){this.y=t}set(t,e){return this.x=t,this.y=e,this}setScalar(t){return this.x=t,this.y=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;default:throw new Error("index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;default:throw new Error("index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y)}copy(t){return this.x=t.x,this.y=t.y,this}add(t){return this.x+=t.x,this.y+=t.y,this}addScalar(t){return this.x+=t,this.y+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this}subScalar(t){return this.x-=t,this.y-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this}multiply(t){return this.x*=t.x,this.y*=t.y,this}multiplyScalar(t){return this.x*=t,this.y*=t,this}divide(t){return this.x/=t.x,this.y/=t.y,this}divideScalar(t){return this.multiplyScalar(1/t)}applyMatrix3(t){let e=this.x,n=this.y,s=t.elements;return this.x=s[0]*e+s[3]*n+s[6],this.y=s[1]*e+s[4]*n+s[7],this}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this}clamp(t,e){return this.x=Math.max(t.x,Math.min(e.x,this.x)),this.y=Math.max(t.y,Math.min(e.y,this.y)),this}clampScalar(t,e){return this.x=Math.max(t,Math.min(e,this.x)),this.y=Math.max(t,Math.min(e,this.y)),this}clampLength(t,e){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Math.max(t,Math.min(e,n)))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this}negate(){return this.x=-this.x,this.y=-this.y,this}dot(t){return this.x*t.x+this.y*t.y}cross(t){return this.x*t.y-this.y*t.x}lengthSq(){return this.x*this.x+this.y*this.y}length(){return Math.sqrt(this.x*this.x+this.y*this.y)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)}normalize(){return this.divideScalar(this.length()||1)}angle(){return Math.atan2(-this.y,-this.x)+Math.PI}angleTo(t){let e=Math.sqrt(this.lengthSq()*t.lengthSq());if(e===0)return Math.PI/2;let n=this.dot(t)/e;return Math.acos(xn(n,-1,1))}distanceTo(t){return Math.sqrt(this.distanceToSquared(t))}distanceToSquared(t){let e=this.x-t.x,n=this.y-t.y;return e*e+n*n}manhattanDistanceTo(t){return Math.abs(this.x-t.x)+Math.abs(this.y-t.y)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this}equals(t){return t.x===this.x&&t.y===this.y}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this}rotateAround(t,e){let n=Math.cos(e),s=Math.sin(e),r=this.x-t.x,o=this.y-t.y;return this.x=r*n-o*s+t.x,this.y=r*s+o*n+t.y,this}random(){return this.x=Math.random(),this.y=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y}},oe=class i{constructor(t,e,n,s,r,o,a,l,c){i.prototype.isMatrix3=!0,this.elements=[1,0,0,0,1,0,0,0,1],t!==void 0&&this.set(t,e,n,s,r,o,a,l,c)}set(t,e,n,s,r,o,a,l,c){let u=this.elements;return u[0]=t,u[1]=s,u[2]=a,u[3]=e,u[4]=r,u[5]=l,u[6]=n,u[7]=o,u[8]=c,this}identity(){return this.set(1,0,0,0,1,0,0,0,1),this}copy(t){let e=this.elements,n=t.elements;return e[0]=n[0],e[1]=n[1],e[2]=n[2],e[3]=n[3],e[4]=n[4],e[5]=n[5],e[6]=n[6],e[7]=n[7],e[8]=n[8],this}extractBasis(t,e,n){return t.setFromMatrix3Column(this,0),e.setFromMatrix3Column(this,1),n.setFromMatrix3Column(this,2),this}setFromMatrix4(t){let e=t.elements;return this.set(e[0],e[4],e[8],e[1],e[5],e[9],e[2],e[6],e[10]),this}multiply(t){return this.multiplyMatrices(this,t)}premultiply(t){return this.multiplyMatrices(t,this)}multiplyMatrices(t,e){let n=t.elements,s=e.elements,r=this.elements,o=n[0],a=n[3],l=n[6],c=n[1],u=n[4],f=n[7],h=n[2],p=n[5],_=n[8],g=s[0],m=s[3],d=s[6],S=s[1],v=s[4],y=s[7],I=s[2],C=s[5],R=s[8];return r[0]=o*g+a*S+l*I,r[3]=o*m+a*v+l*C,r[6]=o*d+a*y+l*R,r[1]=c*g+u*S+f*I,r[4]=c*m+u*v+f*C,r[7]=c*d+u*y+f*R,r[2]=h*g+p*S+_*I,r[5]=h*m+p*v+_*C,r[8]=h*d+p*y+_*R,this}multiplyScalar(t){let e=this.elements;return e[0]*=t,e[3]*=t,e[6]*=t,e[1]*=t,e[4]*=t,e[7]*=t,e[2]*=t,e[5]*=t,e[8]*=t,this}determinant(){let t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],o=t[4],a=t[5],l=t[6],c=t[7],u=t[8];return e*o*u-e*a*c-n*r*u+n*a*l+s*r*c-s*o*l}invert(){let t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],o=t[4],a=t[5],l=t[6],c=t[7],u=t[8],f=u*o-a*c,h=a*l-u*r,p=c*r-o*l,_=e*f+n*h+s*p;if(_===0)return this.set(0,0,0,0,0,0,0,0,0);let g=1/_;return t[0]=f*g,t[1]=(s*c-u*n)*g,t[2]=(a*n-s*o)*g,t[3]=h*g,t[4]=(u*e-s*l)*g,t[5]=(s*r-a*e)*g,t[6]=p*g,t[7]=(n*l-c*e)*g,t[8]=(o*e-n*r)*g,this}transpose(){let t,e=this.elements;return t=e[1],e[1]=e[3],e[3]=t,t=e[2],e[2]=e[6],e[6]=t,t=e[5],e[5]=e[7],e[7]=t,this}getNormalMatrix(t){return this.setFromMatrix4(t).invert().transpose()}transposeIntoArray(t){let e=this.elements;return t[0]=e[0],t[1]=e[3],t[2]=e[6],t[3]=e[1],t[4]=e[4],t[5]=e[7],t[6]=e[2],t[7]=e[5],t[8]=e[8],this}setUvTransform(t,e,n,s,r,o,a){let l=Math.cos(r),c=Math.sin(r);return this.set(n*l,n*c,-n*(l*o+c*a)+o+t,-s*c,s*l,-s*(-c*o+l*a)+a+e,0,0,1),this}scale(t,e){return this.premultiply(Oc.makeScale(t,e)),this}rotate(t){return this.premultiply(Oc.makeRotation(-t)),this}translate(t,e){return this.premultiply(Oc.makeTranslation(t,e)),this}makeTranslation(t,e){return t.isVector2?this.set(1,0,t.x,0,1,t.y,0,0,1):this.set(1,0,t,0,1,e,0,0,1),this}makeRotation(t){let e=Math.cos(t),n=Math.sin(t);return this.set(e,-n,0,n,e,0,0,0,1),this}makeScale(t,e){return this.set(t,0,0,0,e,0,0,0,1),this}equals(t){let e=this.elements,n=t.elements;for(let s=0;s<9;s++)if(e[s]!==n[s])return!1;return!0}fromArray(t,e=0){for(let n=0;n<9;n++)this.elements[n]=t[n+e];return this}toArray(t=[],e=0){let n=this.elements;return t[e]=n[0],t[e+1]=n[1],t[e+2]=n[2],t[e+3]=n[3],t[e+4]=n[4],t[e+5]=n[5],t[e+6]=n[6],t[e+7]=n[7],t[e+8]=n[8],t}clone(){return new this.constructor().fromArray(this.elements)}},Oc=new oe;function Rm(i){for(let t=i.length-1;t>=0;--t)if(i[t]>=65535)return!0;return!1}function el(i){return document.createElementNS("http://www.w3.org/1999/xhtml",i)}function wx(){let i=el("canvas");return i.style.display="block",i}var _p={};function Do(i){i in _p||(_p[i]=!0,console.warn(i))}function Ex(i,t,e){return new Promise(function(n,s){function r(){switch(i.clientWaitSync(t,i.SYNC_FLUSH_COMMANDS_BIT,0)){case i.WAIT_FAILED:s();break;case i.TIMEOUT_EXPIRED:setTimeout(r,e);break;default:n()}}setTimeout(r,e)})}function Tx(i){let t=i.elements;t[2]=.5*t[2]+.5*t[3],t[6]=.5*t[6]+.5*t[7],t[10]=.5*t[10]+.5*t[11],t[14]=.5*t[14]+.5*t[15]}function Ax(i){let t=i.elements;t[11]===-1?(t[10]=-t[10]-1,t[14]=-t[14]):(t[10]=-t[10],t[14]=-t[14]+1)}var ye={enabled:!0,workingColorSpace:ro,spaces:{},convert:function(i,t,e){return this.enabled===!1||t===e||!t||!e||(this.spaces[t].transfer===Ce&&(i.r=Ki(i.r),i.g=Ki(i.g),i.b=Ki(i.b)),this.spaces[t].primaries!==this.spaces[e].primaries&&(i.applyMatrix3(this.spaces[t].toXYZ),i.applyMatrix3(this.spaces[e].fromXYZ)),this.spaces[e].transfer===Ce&&(i.r=qr(i.r),i.g=qr(i.g),i.b=qr(i.b))),i},fromWorkingColorSpace:function(i,t){return this.convert(i,this.workingColorSpace,t)},toWorkingColorSpace:function(i,t){return this.convert(i,t,this.workingColorSpace)},getPrimaries:function(i){return this.spaces[i].primaries},getTransfer:function(i){return i===xs?El:this.spaces[i].transfer},getLuminanceCoefficients:function(i,t=this.workingColorSpace){return i.fromArray(this.spaces[t].luminanceCoefficients)},define:function(i){Object.assign(this.spaces,i)},_getMatrix:function(i,t,e){return i.copy(this.spaces[t].toXYZ).multiply(this.spaces[e].fromXYZ)},_getDrawingBufferColorSpace:function(i){return this.spaces[i].outputColorSpaceConfig.drawingBufferColorSpace},_getUnpackColorSpace:function(i=this.workingColorSpace){return this.spaces[i].workingColorSpaceConfig.unpackColorSpace}};function Ki(i){return i<.04045?i*.0773993808:Math.pow(i*.9478672986+.0521327014,2.4)}function qr(i){return i<.0031308?i*12.92:1.055*Math.pow(i,.41666)-.055}var xp=[.64,.33,.3,.6,.15,.06],yp=[.2126,.7152,.0722],vp=[.3127,.329],Mp=new oe().set(.4123908,.3575843,.1804808,.212639,.7151687,.0721923,.0193308,.1191948,.9505322),Sp=new oe().set(3.2409699,-1.5373832,-.4986108,-.9692436,1.8759675,.0415551,.0556301,-.203977,1.0569715);ye.define({[ro]:{primaries:xp,whitePoint:vp,transfer:El,toXYZ:Mp,fromXYZ:Sp,luminanceCoefficients:yp,workingColorSpaceConfig:{unpackColorSpace:Un},outputColorSpaceConfig:{drawingBufferColorSpace:Un}},[Un]:{primaries:xp,whitePoint:vp,transfer:Ce,toXYZ:Mp,fromXYZ:Sp,luminanceCoefficients:yp,outputColorSpaceConfig:{drawingBufferColorSpace:Un}}});var Rr,Jh=class{static getDataURL(t){if(/^data:/i.test(t.src)||typeof HTMLCanvasElement>"u")return t.src;let e;if(t instanceof HTMLCanvasElement)e=t;else{Rr===void 0&&(Rr=el("canvas")),Rr.width=t.width,Rr.height=t.height;let n=Rr.getContext("2d");t instanceof ImageData?n.putImageData(t,0,0):n.drawImage(t,0,0,t.width,t.height),e=Rr}return e.width>2048||e.height>2048?(console.warn("THREE.ImageUtils.getDataURL: Image converted to jpg for performance reasons",t),e.toDataURL("image/jpeg",.6)):e.toDataURL("image/png")}static sRGBToLinear(t){if(typeof HTMLImageElement<"u"&&t instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&t instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&t instanceof ImageBitmap){let e=el("canvas");e.width=t.width,e.height=t.height;let n=e.getContext("2d");n.drawImage(t,0,0,t.width,t.height);let s=n.getImageData(0,0,t.width,t.height),r=s.data;for(let o=0;o<r.length;o++)r[o]=Ki(r[o]/255)*255;return n.putImageData(s,0,0),e}else if(t.data){let e=t.data.slice(0);for(let n=0;n<e.length;n++)e instanceof Uint8Array||e instanceof Uint8ClampedArray?e[n]=Math.floor(Ki(e[n]/255)*255):e[n]=Ki(e[n]);return{data:e,width:t.width,height:t.height}}else return console.warn("THREE.ImageUtils.sRGBToLinear(): Unsupported image type. No color space conversion applied."),t}},Cx=0,nl=class{constructor(t=null){this.isSource=!0,Object.defineProperty(this,"id",{value:Cx++}),this.uuid=oo(),this.data=t,this.dataReady=!0,this.version=0}set needsUpdate(t){t===!0&&this.version++}toJSON(t){let e=t===void 0||typeof t=="string";if(!e&&t.images[this.uuid]!==void 0)return t.images[this.uuid];let n={uuid:this.uuid,url:""},s=this.data;if(s!==null){let r;if(Array.isArray(s)){r=[];for(let o=0,a=s.length;o<a;o++)s[o].isDataTexture?r.push(Fc(s[o].image)):r.push(Fc(s[o]))}else r=Fc(s);n.url=r}return e||(t.images[this.uuid]=n),n}};function Fc(i){return typeof HTMLImageElement<"u"&&i instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&i instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&i instanceof ImageBitmap?Jh.getDataURL(i):i.data?{data:Array.from(i.data),width:i.width,height:i.height,type:i.data.constructor.name}:(console.warn("THREE.Texture: Unable to serialize Texture."),{})}var Rx=0,Fn=class i extends Qi{constructor(t=i.DEFAULT_IMAGE,e=i.DEFAULT_MAPPING,n=Zs,s=Zs,r=Ii,o=Js,a=_i,l=ji,c=i.DEFAULT_ANISOTROPY,u=xs){super(),this.isTexture=!0,Object.defineProperty(this,"id",{value:Rx++}),this.uuid=oo(),this.name="",this.source=new nl(t),this.mipmaps=[],this.mapping=e,this.channel=0,this.wrapS=n,this.wrapT=s,this.magFilter=r,this.minFilter=o,this.anisotropy=c,this.format=a,this.internalFormat=null,this.type=l,this.offset=new se(0,0),this.repeat=new se(1,1),this.center=new se(0,0),this.rotation=0,this.matrixAutoUpdate=!0,this.matrix=new oe,this.generateMipmaps=!0,this.premultiplyAlpha=!1,this.flipY=!0,this.unpackAlignment=4,this.colorSpace=u,this.userData={},this.version=0,this.onUpdate=null,this.isRenderTargetTexture=!1,this.pmremVersion=0}get image(){return this.source.data}set image(t=null){this.source.data=t}updateMatrix(){this.matrix.setUvTransform(this.offset.x,this.offset.y,this.repeat.x,this.repeat.y,this.rotation,this.center.x,this.center.y)}clone(){return new this.constructor().copy(this)}copy(t){return this.name=t.name,this.source=t.source,this.mipmaps=t.mipmaps.slice(0),this.mapping=t.mapping,this.channel=t.channel,this.wrapS=t.wrapS,this.wrapT=t.wrapT,this.magFilter=t.magFilter,this.minFilter=t.minFilter,this.anisotropy=t.anisotropy,this.format=t.format,this.internalFormat=t.internalFormat,this.type=t.type,this.offset.copy(t.offset),this.repeat.copy(t.repeat),this.center.copy(t.center),this.rotation=t.rotation,this.matrixAutoUpdate=t.matrixAutoUpdate,this.matrix.copy(t.matrix),this.generateMipmaps=t.generateMipmaps,this.premultiplyAlpha=t.premultiplyAlpha,this.flipY=t.flipY,this.unpackAlignment=t.unpackAlignment,this.colorSpace=t.colorSpace,this.userData=JSON.parse(JSON.stringify(t.userData)),this.needsUpdate=!0,this}toJSON(t){let e=t===void 0||typeof t=="string";if(!e&&t.textures[this.uuid]!==void 0)return t.textures[this.uuid];let n={metadata:{version:4.6,type:"Texture",generator:"Texture.toJSON"},uuid:this.uuid,name:this.name,image:this.source.toJSON(t).uuid,mapping:this.mapping,channel:this.channel,repeat:[this.repeat.x,this.repeat.y],offset:[this.offset.x,this.offset.y],center:[this.center.x,this.center.y],rotation:this.rotation,wrap:[this.wrapS,this.wrapT],format:this.format,internalFormat:this.internalFormat,type:this.type,colorSpace:this.colorSpace,minFilter:this.minFilter,magFilter:this.magFilter,anisotropy:this.anisotropy,flipY:this.flipY,generateMipmaps:this.generateMipmaps,premultiplyAlpha:this.premultiplyAlpha,unpackAlignment:this.unpackAlignment};return Object.keys(this.userData).length>0&&(n.userData=this.userData),e||(t.textures[this.uuid]=n),n}dispose(){this.dispatchEvent({type:"dispose"})}transformUv(t){if(this.mapping!==mm)return t;if(t.applyMatrix3(this.matrix),t.x<0||t.x>1)switch(this.wrapS){case Mh:t.x=t.x-Math.floor(t.x);break;case Zs:t.x=t.x<0?0:1;break;case Sh:Math.abs(Math.floor(t.x)%2)===1?t.x=Math.ceil(t.x)-t.x:t.x=t.x-Math.floor(t.x);break}if(t.y<0||t.y>1)switch(this.wrapT){case Mh:t.y=t.y-Math.floor(t.y);break;case Zs:t.y=t.y<0?0:1;break;case Sh:Math.abs(Math.floor(t.y)%2)===1?t.y=Math.ceil(t.y)-t.y:t.y=t.y-Math.floor(t.y);break}return this.flipY&&(t.y=1-t.y),t}set needsUpdate(t){t===!0&&(this.version++,this.source.needsUpdate=!0)}set needsPMREMUpdate(t){t===!0&&this.pmremVersion++}};Fn.DEFAULT_IMAGE=null;Fn.DEFAULT_MAPPING=mm;Fn.DEFAULT_ANISOTROPY=1;var He=class i{constructor(t=0,e=0,n=0,s=1){i.prototype.isVector4=!0,this.x=t,this.y=e,this.z=n,this.w=s}get width(){return this.z}set width(t){this.z=t}get height(){return this.w}set height(t){this.w=t}set(t,e,n,s){return this.x=t,this.y=e,this.z=n,this.w=s,this}setScalar(t){return this.x=t,this.y=t,this.z=t,this.w=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setZ(t){return this.z=t,this}setW(t){return this.w=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;case 2:this.z=e;break;case 3:this.w=e;break;default:throw new Error("index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;case 2:return this.z;case 3:return this.w;default:throw new Error("index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y,this.z,this.w)}copy(t){return this.x=t.x,this.y=t.y,this.z=t.z,this.w=t.w!==void 0?t.w:1,this}add(t){return this.x+=t.x,this.y+=t.y,this.z+=t.z,this.w+=t.w,this}addScalar(t){return this.x+=t,this.y+=t,this.z+=t,this.w+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this.z=t.z+e.z,this.w=t.w+e.w,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this.z+=t.z*e,this.w+=t.w*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this.z-=t.z,this.w-=t.w,this}subScalar(t){return this.x-=t,this.y-=t,this.z-=t,this.w-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this.z=t.z-e.z,this.w=t.w-e.w,this}multiply(t){return this.x*=t.x,this.y*=t.y,this.z*=t.z,this.w*=t.w,this}multiplyScalar(t){return this.x*=t,this.y*=t,this.z*=t,this.w*=t,this}applyMatrix4(t){let e=this.x,n=this.y,s=this.z,r=this.w,o=t.elements;return this.x=o[0]*e+o[4]*n+o[8]*s+o[12]*r,this.y=o[1]*e+o[5]*n+o[9]*s+o[13]*r,this.z=o[2]*e+o[6]*n+o[10]*s+o[14]*r,this.w=o[3]*e+o[7]*n+o[11]*s+o[15]*r,this}divide(t){return this.x/=t.x,this.y/=t.y,this.z/=t.z,this.w/=t.w,this}divideScalar(t){return this.multiplyScalar(1/t)}setAxisAngleFromQuaternion(t){this.w=2*Math.acos(t.w);let e=Math.sqrt(1-t.w*t.w);return e<1e-4?(this.x=1,this.y=0,this.z=0):(this.x=t.x/e,this.y=t.y/e,this.z=t.z/e),this}setAxisAngleFromRotationMatrix(t){let e,n,s,r,l=t.elements,c=l[0],u=l[4],f=l[8],h=l[1],p=l[5],_=l[9],g=l[2],m=l[6],d=l[10];if(Math.abs(u-h)<.01&&Math.abs(f-g)<.01&&Math.abs(_-m)<.01){if(Math.abs(u+h)<.1&&Math.abs(f+g)<.1&&Math.abs(_+m)<.1&&Math.abs(c+p+d-3)<.1)return this.set(1,0,0,0),this;e=Math.PI;let v=(c+1)/2,y=(p+1)/2,I=(d+1)/2,C=(u+h)/4,R=(f+g)/4,L=(_+m)/4;return v>y&&v>I?v<.01?(n=0,s=.707106781,r=.707106781):(n=Math.sqrt(v),s=C/n,r=R/n):y>I?y<.01?(n=.707106781,s=0,r=.707106781):(s=Math.sqrt(y),n=C/s,r=L/s):I<.01?(n=.707106781,s=.707106781,r=0):(r=Math.sqrt(I),n=R/r,s=L/r),this.set(n,s,r,e),this}let S=Math.sqrt((m-_)*(m-_)+(f-g)*(f-g)+(h-u)*(h-u));return Math.abs(S)<.001&&(S=1),this.x=(m-_)/S,this.y=(f-g)/S,this.z=(h-u)/S,this.w=Math.acos((c+p+d-1)/2),this}setFromMatrixPosition(t){let e=t.elements;return this.x=e[12],this.y=e[13],this.z=e[14],this.w=e[15],this}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this.z=Math.min(this.z,t.z),this.w=Math.min(this.w,t.w),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this.z=Math.max(this.z,t.z),this.w=Math.max(this.w,t.w),this}clamp(t,e){return this.x=Math.max(t.x,Math.min(e.x,this.x)),this.y=Math.max(t.y,Math.min(e.y,this.y)),this.z=Math.max(t.z,Math.min(e.z,this.z)),this.w=Math.max(t.w,Math.min(e.w,this.w)),this}clampScalar(t,e){return this.x=Math.max(t,Math.min(e,this.x)),this.y=Math.max(t,Math.min(e,this.y)),this.z=Math.max(t,Math.min(e,this.z)),this.w=Math.max(t,Math.min(e,this.w)),this}clampLength(t,e){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Math.max(t,Math.min(e,n)))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this.w=Math.floor(this.w),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this.w=Math.ceil(this.w),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this.w=Math.round(this.w),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this.w=Math.trunc(this.w),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this.w=-this.w,this}dot(t){return this.x*t.x+this.y*t.y+this.z*t.z+this.w*t.w}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z+this.w*this.w)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)+Math.abs(this.w)}normalize(){return this.divideScalar(this.length()||1)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this.z+=(t.z-this.z)*e,this.w+=(t.w-this.w)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this.z=t.z+(e.z-t.z)*n,this.w=t.w+(e.w-t.w)*n,this}equals(t){return t.x===this.x&&t.y===this.y&&t.z===this.z&&t.w===this.w}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this.z=t[e+2],this.w=t[e+3],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t[e+2]=this.z,t[e+3]=this.w,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this.z=t.getZ(e),this.w=t.getW(e),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this.w=Math.random(),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z,yield this.w}},Kh=class extends Qi{constructor(t=1,e=1,n={}){super(),this.isRenderTarget=!0,this.width=t,this.height=e,this.depth=1,this.scissor=new He(0,0,t,e),this.scissorTest=!1,this.viewport=new He(0,0,t,e);let s={width:t,height:e,depth:1};n=Object.assign({generateMipmaps:!1,internalFormat:null,minFilter:Ii,depthBuffer:!0,stencilBuffer:!1,resolveDepthBuffer:!0,resolveStencilBuffer:!0,depthTexture:null,samples:0,count:1},n);let r=new Fn(s,n.mapping,n.wrapS,n.wrapT,n.magFilter,n.minFilter,n.format,n.type,n.anisotropy,n.colorSpace);r.flipY=!1,r.generateMipmaps=n.generateMipmaps,r.internalFormat=n.internalFormat,this.textures=[];let o=n.count;for(let a=0;a<o;a++)this.textures[a]=r.clone(),this.textures[a].isRenderTargetTexture=!0;this.depthBuffer=n.depthBuffer,this.stencilBuffer=n.stencilBuffer,this.resolveDepthBuffer=n.resolveDepthBuffer,this.resolveStencilBuffer=n.resolveStencilBuffer,this.depthTexture=n.depthTexture,this.samples=n.samples}get texture(){return this.textures[0]}set texture(t){this.textures[0]=t}setSize(t,e,n=1){if(this.width!==t||this.height!==e||this.depth!==n){this.width=t,this.height=e,this.depth=n;for(let s=0,r=this.textures.length;s<r;s++)this.textures[s].image.width=t,this.textures[s].image.height=e,this.textures[s].image.depth=n;this.dispose()}this.viewport.set(0,0,t,e),this.scissor.set(0,0,t,e)}clone(){return new this.constructor().copy(this)}copy(t){this.width=t.width,this.height=t.height,this.depth=t.depth,this.scissor.copy(t.scissor),this.scissorTest=t.scissorTest,this.viewport.copy(t.viewport),this.textures.length=0;for(let n=0,s=t.textures.length;n<s;n++)this.textures[n]=t.textures[n].clone(),this.textures[n].isRenderTargetTexture=!0;let e=Object.assign({},t.texture.image);return this.texture.source=new nl(e),this.depthBuffer=t.depthBuffer,this.stencilBuffer=t.stencilBuffer,this.resolveDepthBuffer=t.resolveDepthBuffer,this.resolveStencilBuffer=t.resolveStencilBuffer,t.depthTexture!==null&&(this.depthTexture=t.depthTexture.clone()),this.samples=t.samples,this}dispose(){this.dispatchEvent({type:"dispose"})}},ts=class extends Kh{constructor(t=1,e=1,n={}){super(t,e,n),this.isWebGLRenderTarget=!0}},il=class extends Fn{constructor(t=null,e=1,n=1,s=1){super(null),this.isDataArrayTexture=!0,this.image={data:t,width:e,height:n,depth:s},this.magFilter=xi,this.minFilter=xi,this.wrapR=Zs,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1,this.layerUpdates=new Set}addLayerUpdate(t){this.layerUpdates.add(t)}clearLayerUpdates(){this.layerUpdates.clear()}};var jh=class extends Fn{constructor(t=null,e=1,n=1,s=1){super(null),this.isData3DTexture=!0,this.image={data:t,width:e,height:n,depth:s},this.magFilter=xi,this.minFilter=xi,this.wrapR=Zs,this.generateMipmaps=!1,this.flipY=!1,this.unpackAlignment=1}};var yi=class{constructor(t=0,e=0,n=0,s=1){this.isQuaternion=!0,this._x=t,this._y=e,this._z=n,this._w=s}static slerpFlat(t,e,n,s,r,o,a){let l=n[s+0],c=n[s+1],u=n[s+2],f=n[s+3],h=r[o+0],p=r[o+1],_=r[o+2],g=r[o+3];if(a===0){t[e+0]=l,t[e+1]=c,t[e+2]=u,t[e+3]=f;return}if(a===1){t[e+0]=h,t[e+1]=p,t[e+2]=_,t[e+3]=g;return}if(f!==g||l!==h||c!==p||u!==_){let m=1-a,d=l*h+c*p+u*_+f*g,S=d>=0?1:-1,v=1-d*d;if(v>Number.EPSILON){let I=Math.sqrt(v),C=Math.atan2(I,d*S);m=Math.sin(m*C)/I,a=Math.sin(a*C)/I}let y=a*S;if(l=l*m+h*y,c=c*m+p*y,u=u*m+_*y,f=f*m+g*y,m===1-a){let I=1/Math.sqrt(l*l+c*c+u*u+f*f);l*=I,c*=I,u*=I,f*=I}}t[e]=l,t[e+1]=c,t[e+2]=u,t[e+3]=f}static multiplyQuaternionsFlat(t,e,n,s,r,o){let a=n[s],l=n[s+1],c=n[s+2],u=n[s+3],f=r[o],h=r[o+1],p=r[o+2],_=r[o+3];return t[e]=a*_+u*f+l*p-c*h,t[e+1]=l*_+u*h+c*f-a*p,t[e+2]=c*_+u*p+a*h-l*f,t[e+3]=u*_-a*f-l*h-c*p,t}get x(){return this._x}set x(t){this._x=t,this._onChangeCallback()}get y(){return this._y}set y(t){this._y=t,this._onChangeCallback()}get z(){return this._z}set z(t){this._z=t,this._onChangeCallback()}get w(){return this._w}set w(t){this._w=t,this._onChangeCallback()}set(t,e,n,s){return this._x=t,this._y=e,this._z=n,this._w=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._w)}copy(t){return this._x=t.x,this._y=t.y,this._z=t.z,this._w=t.w,this._onChangeCallback(),this}setFromEuler(t,e=!0){let n=t._x,s=t._y,r=t._z,o=t._order,a=Math.cos,l=Math.sin,c=a(n/2),u=a(s/2),f=a(r/2),h=l(n/2),p=l(s/2),_=l(r/2);switch(o){case"XYZ":this._x=h*u*f+c*p*_,this._y=c*p*f-h*u*_,this._z=c*u*_+h*p*f,this._w=c*u*f-h*p*_;break;case"YXZ":this._x=h*u*f+c*p*_,this._y=c*p*f-h*u*_,this._z=c*u*_-h*p*f,this._w=c*u*f+h*p*_;break;case"ZXY":this._x=h*u*f-c*p*_,this._y=c*p*f+h*u*_,this._z=c*u*_+h*p*f,this._w=c*u*f-h*p*_;break;case"ZYX":this._x=h*u*f-c*p*_,this._y=c*p*f+h*u*_,this._z=c*u*_-h*p*f,this._w=c*u*f+h*p*_;break;case"YZX":this._x=h*u*f+c*p*_,this._y=c*p*f+h*u*_,this._z=c*u*_-h*p*f,this._w=c*u*f-h*p*_;break;case"XZY":this._x=h*u*f-c*p*_,this._y=c*p*f-h*u*_,this._z=c*u*_+h*p*f,this._w=c*u*f+h*p*_;break;default:console.warn("THREE.Quaternion: .setFromEuler() encountered an unknown order: "+o)}return e===!0&&this._onChangeCallback(),this}setFromAxisAngle(t,e){let n=e/2,s=Math.sin(n);return this._x=t.x*s,this._y=t.y*s,this._z=t.z*s,this._w=Math.cos(n),this._onChangeCallback(),this}setFromRotationMatrix(t){let e=t.elements,n=e[0],s=e[4],r=e[8],o=e[1],a=e[5],l=e[9],c=e[2],u=e[6],f=e[10],h=n+a+f;if(h>0){let p=.5/Math.sqrt(h+1);this._w=.25/p,this._x=(u-l)*p,this._y=(r-c)*p,this._z=(o-s)*p}else if(n>a&&n>f){let p=2*Math.sqrt(1+n-a-f);this._w=(u-l)/p,this._x=.25*p,this._y=(s+o)/p,this._z=(r+c)/p}else if(a>f){let p=2*Math.sqrt(1+a-n-f);this._w=(r-c)/p,this._x=(s+o)/p,this._y=.25*p,this._z=(l+u)/p}else{let p=2*Math.sqrt(1+f-n-a);this._w=(o-s)/p,this._x=(r+c)/p,this._y=(l+u)/p,this._z=.25*p}return this._onChangeCallback(),this}setFromUnitVectors(t,e){let n=t.dot(e)+1;return n<Number.EPSILON?(n=0,Math.abs(t.x)>Math.abs(t.z)?(this._x=-t.y,this._y=t.x,this._z=0,this._w=n):(this._x=0,this._y=-t.z,this._z=t.y,this._w=n)):(this._x=t.y*e.z-t.z*e.y,this._y=t.z*e.x-t.x*e.z,this._z=t.x*e.y-t.y*e.x,this._w=n),this.normalize()}angleTo(t){return 2*Math.acos(Math.abs(xn(this.dot(t),-1,1)))}rotateTowards(t,e){let n=this.angleTo(t);if(n===0)return this;let s=Math.min(1,e/n);return this.slerp(t,s),this}identity(){return this.set(0,0,0,1)}invert(){return this.conjugate()}conjugate(){return this._x*=-1,this._y*=-1,this._z*=-1,this._onChangeCallback(),this}dot(t){return this._x*t._x+this._y*t._y+this._z*t._z+this._w*t._w}lengthSq(){return this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w}length(){return Math.sqrt(this._x*this._x+this._y*this._y+this._z*this._z+this._w*this._w)}normalize(){let t=this.length();return t===0?(this._x=0,this._y=0,this._z=0,this._w=1):(t=1/t,this._x=this._x*t,this._y=this._y*t,this._z=this._z*t,this._w=this._w*t),this._onChangeCallback(),this}multiply(t){return this.multiplyQuaternions(this,t)}premultiply(t){return this.multiplyQuaternions(t,this)}multiplyQuaternions(t,e){let n=t._x,s=t._y,r=t._z,o=t._w,a=e._x,l=e._y,c=e._z,u=e._w;return this._x=n*u+o*a+s*c-r*l,this._y=s*u+o*l+r*a-n*c,this._z=r*u+o*c+n*l-s*a,this._w=o*u-n*a-s*l-r*c,this._onChangeCallback(),this}slerp(t,e){if(e===0)return this;if(e===1)return this.copy(t);let n=this._x,s=this._y,r=this._z,o=this._w,a=o*t._w+n*t._x+s*t._y+r*t._z;if(a<0?(this._w=-t._w,this._x=-t._x,this._y=-t._y,this._z=-t._z,a=-a):this.copy(t),a>=1)return this._w=o,this._x=n,this._y=s,this._z=r,this;let l=1-a*a;if(l<=Number.EPSILON){let p=1-e;return this._w=p*o+e*this._w,this._x=p*n+e*this._x,this._y=p*s+e*this._y,this._z=p*r+e*this._z,this.normalize(),this}let c=Math.sqrt(l),u=Math.atan2(c,a),f=Math.sin((1-e)*u)/c,h=Math.sin(e*u)/c;return this._w=o*f+this._w*h,this._x=n*f+this._x*h,this._y=s*f+this._y*h,this._z=r*f+this._z*h,this._onChangeCallback(),this}slerpQuaternions(t,e,n){return this.copy(t).slerp(e,n)}random(){let t=2*Math.PI*Math.random(),e=2*Math.PI*Math.random(),n=Math.random(),s=Math.sqrt(1-n),r=Math.sqrt(n);return this.set(s*Math.sin(t),s*Math.cos(t),r*Math.sin(e),r*Math.cos(e))}equals(t){return t._x===this._x&&t._y===this._y&&t._z===this._z&&t._w===this._w}fromArray(t,e=0){return this._x=t[e],this._y=t[e+1],this._z=t[e+2],this._w=t[e+3],this._onChangeCallback(),this}toArray(t=[],e=0){return t[e]=this._x,t[e+1]=this._y,t[e+2]=this._z,t[e+3]=this._w,t}fromBufferAttribute(t,e){return this._x=t.getX(e),this._y=t.getY(e),this._z=t.getZ(e),this._w=t.getW(e),this._onChangeCallback(),this}toJSON(){return this.toArray()}_onChange(t){return this._onChangeCallback=t,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._w}},Y=class i{constructor(t=0,e=0,n=0){i.prototype.isVector3=!0,this.x=t,this.y=e,this.z=n}set(t,e,n){return n===void 0&&(n=this.z),this.x=t,this.y=e,this.z=n,this}setScalar(t){return this.x=t,this.y=t,this.z=t,this}setX(t){return this.x=t,this}setY(t){return this.y=t,this}setZ(t){return this.z=t,this}setComponent(t,e){switch(t){case 0:this.x=e;break;case 1:this.y=e;break;case 2:this.z=e;break;default:throw new Error("index is out of range: "+t)}return this}getComponent(t){switch(t){case 0:return this.x;case 1:return this.y;case 2:return this.z;default:throw new Error("index is out of range: "+t)}}clone(){return new this.constructor(this.x,this.y,this.z)}copy(t){return this.x=t.x,this.y=t.y,this.z=t.z,this}add(t){return this.x+=t.x,this.y+=t.y,this.z+=t.z,this}addScalar(t){return this.x+=t,this.y+=t,this.z+=t,this}addVectors(t,e){return this.x=t.x+e.x,this.y=t.y+e.y,this.z=t.z+e.z,this}addScaledVector(t,e){return this.x+=t.x*e,this.y+=t.y*e,this.z+=t.z*e,this}sub(t){return this.x-=t.x,this.y-=t.y,this.z-=t.z,this}subScalar(t){return this.x-=t,this.y-=t,this.z-=t,this}subVectors(t,e){return this.x=t.x-e.x,this.y=t.y-e.y,this.z=t.z-e.z,this}multiply(t){return this.x*=t.x,this.y*=t.y,this.z*=t.z,this}multiplyScalar(t){return this.x*=t,this.y*=t,this.z*=t,this}multiplyVectors(t,e){return this.x=t.x*e.x,this.y=t.y*e.y,this.z=t.z*e.z,this}applyEuler(t){return this.applyQuaternion(bp.setFromEuler(t))}applyAxisAngle(t,e){return this.applyQuaternion(bp.setFromAxisAngle(t,e))}applyMatrix3(t){let e=this.x,n=this.y,s=this.z,r=t.elements;return this.x=r[0]*e+r[3]*n+r[6]*s,this.y=r[1]*e+r[4]*n+r[7]*s,this.z=r[2]*e+r[5]*n+r[8]*s,this}applyNormalMatrix(t){return this.applyMatrix3(t).normalize()}applyMatrix4(t){let e=this.x,n=this.y,s=this.z,r=t.elements,o=1/(r[3]*e+r[7]*n+r[11]*s+r[15]);return this.x=(r[0]*e+r[4]*n+r[8]*s+r[12])*o,this.y=(r[1]*e+r[5]*n+r[9]*s+r[13])*o,this.z=(r[2]*e+r[6]*n+r[10]*s+r[14])*o,this}applyQuaternion(t){let e=this.x,n=this.y,s=this.z,r=t.x,o=t.y,a=t.z,l=t.w,c=2*(o*s-a*n),u=2*(a*e-r*s),f=2*(r*n-o*e);return this.x=e+l*c+o*f-a*u,this.y=n+l*u+a*c-r*f,this.z=s+l*f+r*u-o*c,this}project(t){return this.applyMatrix4(t.matrixWorldInverse).applyMatrix4(t.projectionMatrix)}unproject(t){return this.applyMatrix4(t.projectionMatrixInverse).applyMatrix4(t.matrixWorld)}transformDirection(t){let e=this.x,n=this.y,s=this.z,r=t.elements;return this.x=r[0]*e+r[4]*n+r[8]*s,this.y=r[1]*e+r[5]*n+r[9]*s,this.z=r[2]*e+r[6]*n+r[10]*s,this.normalize()}divide(t){return this.x/=t.x,this.y/=t.y,this.z/=t.z,this}divideScalar(t){return this.multiplyScalar(1/t)}min(t){return this.x=Math.min(this.x,t.x),this.y=Math.min(this.y,t.y),this.z=Math.min(this.z,t.z),this}max(t){return this.x=Math.max(this.x,t.x),this.y=Math.max(this.y,t.y),this.z=Math.max(this.z,t.z),this}clamp(t,e){return this.x=Math.max(t.x,Math.min(e.x,this.x)),this.y=Math.max(t.y,Math.min(e.y,this.y)),this.z=Math.max(t.z,Math.min(e.z,this.z)),this}clampScalar(t,e){return this.x=Math.max(t,Math.min(e,this.x)),this.y=Math.max(t,Math.min(e,this.y)),this.z=Math.max(t,Math.min(e,this.z)),this}clampLength(t,e){let n=this.length();return this.divideScalar(n||1).multiplyScalar(Math.max(t,Math.min(e,n)))}floor(){return this.x=Math.floor(this.x),this.y=Math.floor(this.y),this.z=Math.floor(this.z),this}ceil(){return this.x=Math.ceil(this.x),this.y=Math.ceil(this.y),this.z=Math.ceil(this.z),this}round(){return this.x=Math.round(this.x),this.y=Math.round(this.y),this.z=Math.round(this.z),this}roundToZero(){return this.x=Math.trunc(this.x),this.y=Math.trunc(this.y),this.z=Math.trunc(this.z),this}negate(){return this.x=-this.x,this.y=-this.y,this.z=-this.z,this}dot(t){return this.x*t.x+this.y*t.y+this.z*t.z}lengthSq(){return this.x*this.x+this.y*this.y+this.z*this.z}length(){return Math.sqrt(this.x*this.x+this.y*this.y+this.z*this.z)}manhattanLength(){return Math.abs(this.x)+Math.abs(this.y)+Math.abs(this.z)}normalize(){return this.divideScalar(this.length()||1)}setLength(t){return this.normalize().multiplyScalar(t)}lerp(t,e){return this.x+=(t.x-this.x)*e,this.y+=(t.y-this.y)*e,this.z+=(t.z-this.z)*e,this}lerpVectors(t,e,n){return this.x=t.x+(e.x-t.x)*n,this.y=t.y+(e.y-t.y)*n,this.z=t.z+(e.z-t.z)*n,this}cross(t){return this.crossVectors(this,t)}crossVectors(t,e){let n=t.x,s=t.y,r=t.z,o=e.x,a=e.y,l=e.z;return this.x=s*l-r*a,this.y=r*o-n*l,this.z=n*a-s*o,this}projectOnVector(t){let e=t.lengthSq();if(e===0)return this.set(0,0,0);let n=t.dot(this)/e;return this.copy(t).multiplyScalar(n)}projectOnPlane(t){return Bc.copy(this).projectOnVector(t),this.sub(Bc)}reflect(t){return this.sub(Bc.copy(t).multiplyScalar(2*this.dot(t)))}angleTo(t){let e=Math.sqrt(this.lengthSq()*t.lengthSq());if(e===0)return Math.PI/2;let n=this.dot(t)/e;return Math.acos(xn(n,-1,1))}distanceTo(t){return Math.sqrt(this.distanceToSquared(t))}distanceToSquared(t){let e=this.x-t.x,n=this.y-t.y,s=this.z-t.z;return e*e+n*n+s*s}manhattanDistanceTo(t){return Math.abs(this.x-t.x)+Math.abs(this.y-t.y)+Math.abs(this.z-t.z)}setFromSpherical(t){return this.setFromSphericalCoords(t.radius,t.phi,t.theta)}setFromSphericalCoords(t,e,n){let s=Math.sin(e)*t;return this.x=s*Math.sin(n),this.y=Math.cos(e)*t,this.z=s*Math.cos(n),this}setFromCylindrical(t){return this.setFromCylindricalCoords(t.radius,t.theta,t.y)}setFromCylindricalCoords(t,e,n){return this.x=t*Math.sin(e),this.y=n,this.z=t*Math.cos(e),this}setFromMatrixPosition(t){let e=t.elements;return this.x=e[12],this.y=e[13],this.z=e[14],this}setFromMatrixScale(t){let e=this.setFromMatrixColumn(t,0).length(),n=this.setFromMatrixColumn(t,1).length(),s=this.setFromMatrixColumn(t,2).length();return this.x=e,this.y=n,this.z=s,this}setFromMatrixColumn(t,e){return this.fromArray(t.elements,e*4)}setFromMatrix3Column(t,e){return this.fromArray(t.elements,e*3)}setFromEuler(t){return this.x=t._x,this.y=t._y,this.z=t._z,this}setFromColor(t){return this.x=t.r,this.y=t.g,this.z=t.b,this}equals(t){return t.x===this.x&&t.y===this.y&&t.z===this.z}fromArray(t,e=0){return this.x=t[e],this.y=t[e+1],this.z=t[e+2],this}toArray(t=[],e=0){return t[e]=this.x,t[e+1]=this.y,t[e+2]=this.z,t}fromBufferAttribute(t,e){return this.x=t.getX(e),this.y=t.getY(e),this.z=t.getZ(e),this}random(){return this.x=Math.random(),this.y=Math.random(),this.z=Math.random(),this}randomDirection(){let t=Math.random()*Math.PI*2,e=Math.random()*2-1,n=Math.sqrt(1-e*e);return this.x=n*Math.cos(t),this.y=e,this.z=n*Math.sin(t),this}*[Symbol.iterator](){yield this.x,yield this.y,yield this.z}},Bc=new Y,bp=new yi,js=class{constructor(t=new Y(1/0,1/0,1/0),e=new Y(-1/0,-1/0,-1/0)){this.isBox3=!0,this.min=t,this.max=e}set(t,e){return this.min.copy(t),this.max.copy(e),this}setFromArray(t){this.makeEmpty();for(let e=0,n=t.length;e<n;e+=3)this.expandByPoint(di.fromArray(t,e));return this}setFromBufferAttribute(t){this.makeEmpty();for(let e=0,n=t.count;e<n;e++)this.expandByPoint(di.fromBufferAttribute(t,e));return this}setFromPoints(t){this.makeEmpty();for(let e=0,n=t.length;e<n;e++)this.expandByPoint(t[e]);return this}setFromCenterAndSize(t,e){let n=di.copy(e).multiplyScalar(.5);return this.min.copy(t).sub(n),this.max.copy(t).add(n),this}setFromObject(t,e=!1){return this.makeEmpty(),this.expandByObject(t,e)}clone(){return new this.constructor().copy(this)}copy(t){return this.min.copy(t.min),this.max.copy(t.max),this}makeEmpty(){return this.min.x=this.min.y=this.min.z=1/0,this.max.x=this.max.y=this.max.z=-1/0,this}isEmpty(){return this.max.x<this.min.x||this.max.y<this.min.y||this.max.z<this.min.z}getCenter(t){return this.isEmpty()?t.set(0,0,0):t.addVectors(this.min,this.max).multiplyScalar(.5)}getSize(t){return this.isEmpty()?t.set(0,0,0):t.subVectors(this.max,this.min)}expandByPoint(t){return this.min.min(t),this.max.max(t),this}expandByVector(t){return this.min.sub(t),this.max.add(t),this}expandByScalar(t){return this.min.addScalar(-t),this.max.addScalar(t),this}expandByObject(t,e=!1){t.updateWorldMatrix(!1,!1);let n=t.geometry;if(n!==void 0){let r=n.getAttribute("position");if(e===!0&&r!==void 0&&t.isInstancedMesh!==!0)for(let o=0,a=r.count;o<a;o++)t.isMesh===!0?t.getVertexPosition(o,di):di.fromBufferAttribute(r,o),di.applyMatrix4(t.matrixWorld),this.expandByPoint(di);else t.boundingBox!==void 0?(t.boundingBox===null&&t.computeBoundingBox(),Ea.copy(t.boundingBox)):(n.boundingBox===null&&n.computeBoundingBox(),Ea.copy(n.boundingBox)),Ea.applyMatrix4(t.matrixWorld),this.union(Ea)}let s=t.children;for(let r=0,o=s.length;r<o;r++)this.expandByObject(s[r],e);return this}containsPoint(t){return t.x>=this.min.x&&t.x<=this.max.x&&t.y>=this.min.y&&t.y<=this.max.y&&t.z>=this.min.z&&t.z<=this.max.z}containsBox(t){return this.min.x<=t.min.x&&t.max.x<=this.max.x&&this.min.y<=t.min.y&&t.max.y<=this.max.y&&this.min.z<=t.min.z&&t.max.z<=this.max.z}getParameter(t,e){return e.set((t.x-this.min.x)/(this.max.x-this.min.x),(t.y-this.min.y)/(this.max.y-this.min.y),(t.z-this.min.z)/(this.max.z-this.min.z))}intersectsBox(t){return t.max.x>=this.min.x&&t.min.x<=this.max.x&&t.max.y>=this.min.y&&t.min.y<=this.max.y&&t.max.z>=this.min.z&&t.min.z<=this.max.z}intersectsSphere(t){return this.clampPoint(t.center,di),di.distanceToSquared(t.center)<=t.radius*t.radius}intersectsPlane(t){let e,n;return t.normal.x>0?(e=t.normal.x*this.min.x,n=t.normal.x*this.max.x):(e=t.normal.x*this.max.x,n=t.normal.x*this.min.x),t.normal.y>0?(e+=t.normal.y*this.min.y,n+=t.normal.y*this.max.y):(e+=t.normal.y*this.max.y,n+=t.normal.y*this.min.y),t.normal.z>0?(e+=t.normal.z*this.min.z,n+=t.normal.z*this.max.z):(e+=t.normal.z*this.max.z,n+=t.normal.z*this.min.z),e<=-t.constant&&n>=-t.constant}intersectsTriangle(t){if(this.isEmpty())return!1;this.getCenter(Co),Ta.subVectors(this.max,Co),Pr.subVectors(t.a,Co),Ir.subVectors(t.b,Co),Lr.subVectors(t.c,Co),fs.subVectors(Ir,Pr),ds.subVectors(Lr,Ir),ks.subVectors(Pr,Lr);let e=[0,-fs.z,fs.y,0,-ds.z,ds.y,0,-ks.z,ks.y,fs.z,0,-fs.x,ds.z,0,-ds.x,ks.z,0,-ks.x,-fs.y,fs.x,0,-ds.y,ds.x,0,-ks.y,ks.x,0];return!kc(e,Pr,Ir,Lr,Ta)||(e=[1,0,0,0,1,0,0,0,1],!kc(e,Pr,Ir,Lr,Ta))?!1:(Aa.crossVectors(fs,ds),e=[Aa.x,Aa.y,Aa.z],kc(e,Pr,Ir,Lr,Ta))}clampPoint(t,e){return e.copy(t).clamp(this.min,this.max)}distanceToPoint(t){return this.clampPoint(t,di).distanceTo(t)}getBoundingSphere(t){return this.isEmpty()?t.makeEmpty():(this.getCenter(t.center),t.radius=this.getSize(di).length()*.5),t}intersect(t){return this.min.max(t.min),this.max.min(t.max),this.isEmpty()&&this.makeEmpty(),this}union(t){return this.min.min(t.min),this.max.max(t.max),this}applyMatrix4(t){return this.isEmpty()?this:(Hi[0].set(this.min.x,this.min.y,this.min.z).applyMatrix4(t),Hi[1].set(this.min.x,this.min.y,this.max.z).applyMatrix4(t),Hi[2].set(this.min.x,this.max.y,this.min.z).applyMatrix4(t),Hi[3].set(this.min.x,this.max.y,this.max.z).applyMatrix4(t),Hi[4].set(this.max.x,this.min.y,this.min.z).applyMatrix4(t),Hi[5].set(this.max.x,this.min.y,this.max.z).applyMatrix4(t),Hi[6].set(this.max.x,this.max.y,this.min.z).applyMatrix4(t),Hi[7].set(this.max.x,this.max.y,this.max.z).applyMatrix4(t),this.setFromPoints(Hi),this)}translate(t){return this.min.add(t),this.max.add(t),this}equals(t){return t.min.equals(this.min)&&t.max.equals(this.max)}},Hi=[new Y,new Y,new Y,new Y,new Y,new Y,new Y,new Y],di=new Y,Ea=new js,Pr=new Y,Ir=new Y,Lr=new Y,fs=new Y,ds=new Y,ks=new Y,Co=new Y,Ta=new Y,Aa=new Y,zs=new Y;function kc(i,t,e,n,s){for(let r=0,o=i.length-3;r<=o;r+=3){zs.fromArray(i,r);let a=s.x*Math.abs(zs.x)+s.y*Math.abs(zs.y)+s.z*Math.abs(zs.z),l=t.dot(zs),c=e.dot(zs),u=n.dot(zs);if(Math.max(-Math.max(l,c,u),Math.min(l,c,u))>a)return!1}return!0}var Px=new js,Ro=new Y,zc=new Y,Qr=class{constructor(t=new Y,e=-1){this.isSphere=!0,this.center=t,this.radius=e}set(t,e){return this.center.copy(t),this.radius=e,this}setFromPoints(t,e){let n=this.center;e!==void 0?n.copy(e):Px.setFromPoints(t).getCenter(n);let s=0;for(let r=0,o=t.length;r<o;r++)s=Math.max(s,n.distanceToSquared(t[r]));return this.radius=Math.sqrt(s),this}copy(t){return this.center.copy(t.center),this.radius=t.radius,this}isEmpty(){return this.radius<0}makeEmpty(){return this.center.set(0,0,0),this.radius=-1,this}containsPoint(t){return t.distanceToSquared(this.center)<=this.radius*this.radius}distanceToPoint(t){return t.distanceTo(this.center)-this.radius}intersectsSphere(t){let e=this.radius+t.radius;return t.center.distanceToSquared(this.center)<=e*e}intersectsBox(t){return t.intersectsSphere(this)}intersectsPlane(t){return Math.abs(t.distanceToPoint(this.center))<=this.radius}clampPoint(t,e){let n=this.center.distanceToSquared(t);return e.copy(t),n>this.radius*this.radius&&(e.sub(this.center).normalize(),e.multiplyScalar(this.radius).add(this.center)),e}getBoundingBox(t){return this.isEmpty()?(t.makeEmpty(),t):(t.set(this.center,this.center),t.expandByScalar(this.radius),t)}applyMatrix4(t){return this.center.applyMatrix4(t),this.radius=this.radius*t.getMaxScaleOnAxis(),this}translate(t){return this.center.add(t),this}expandByPoint(t){if(this.isEmpty())return this.center.copy(t),this.radius=0,this;Ro.subVectors(t,this.center);let e=Ro.lengthSq();if(e>this.radius*this.radius){let n=Math.sqrt(e),s=(n-this.radius)*.5;this.center.addScaledVector(Ro,s/n),this.radius+=s}return this}union(t){return t.isEmpty()?this:this.isEmpty()?(this.copy(t),this):(this.center.equals(t.center)===!0?this.radius=Math.max(this.radius,t.radius):(zc.subVectors(t.center,this.center).setLength(t.radius),this.expandByPoint(Ro.copy(t.center).add(zc)),this.expandByPoint(Ro.copy(t.center).sub(zc))),this)}equals(t){return t.center.equals(this.center)&&t.radius===this.radius}clone(){return new this.constructor().copy(this)}},Gi=new Y,Vc=new Y,Ca=new Y,ps=new Y,Hc=new Y,Ra=new Y,Gc=new Y,to=class{constructor(t=new Y,e=new Y(0,0,-1)){this.origin=t,this.direction=e}set(t,e){return this.origin.copy(t),this.direction.copy(e),this}copy(t){return this.origin.copy(t.origin),this.direction.copy(t.direction),this}at(t,e){return e.copy(this.origin).addScaledVector(this.direction,t)}lookAt(t){return this.direction.copy(t).sub(this.origin).normalize(),this}recast(t){return this.origin.copy(this.at(t,Gi)),this}closestPointToPoint(t,e){e.subVectors(t,this.origin);let n=e.dot(this.direction);return n<0?e.copy(this.origin):e.copy(this.origin).addScaledVector(this.direction,n)}distanceToPoint(t){return Math.sqrt(this.distanceSqToPoint(t))}distanceSqToPoint(t){let e=Gi.subVectors(t,this.origin).dot(this.direction);return e<0?this.origin.distanceToSquared(t):(Gi.copy(this.origin).addScaledVector(this.direction,e),Gi.distanceToSquared(t))}distanceSqToSegment(t,e,n,s){Vc.copy(t).add(e).multiplyScalar(.5),Ca.copy(e).sub(t).normalize(),ps.copy(this.origin).sub(Vc);let r=t.distanceTo(e)*.5,o=-this.direction.dot(Ca),a=ps.dot(this.direction),l=-ps.dot(Ca),c=ps.lengthSq(),u=Math.abs(1-o*o),f,h,p,_;if(u>0)if(f=o*l-a,h=o*a-l,_=r*u,f>=0)if(h>=-_)if(h<=_){let g=1/u;f*=g,h*=g,p=f*(f+o*h+2*a)+h*(o*f+h+2*l)+c}else h=r,f=Math.max(0,-(o*h+a)),p=-f*f+h*(h+2*l)+c;else h=-r,f=Math.max(0,-(o*h+a)),p=-f*f+h*(h+2*l)+c;else h<=-_?(f=Math.max(0,-(-o*r+a)),h=f>0?-r:Math.min(Math.max(-r,-l),r),p=-f*f+h*(h+2*l)+c):h<=_?(f=0,h=Math.min(Math.max(-r,-l),r),p=h*(h+2*l)+c):(f=Math.max(0,-(o*r+a)),h=f>0?r:Math.min(Math.max(-r,-l),r),p=-f*f+h*(h+2*l)+c);else h=o>0?-r:r,f=Math.max(0,-(o*h+a)),p=-f*f+h*(h+2*l)+c;return n&&n.copy(this.origin).addScaledVector(this.direction,f),s&&s.copy(Vc).addScaledVector(Ca,h),p}intersectSphere(t,e){Gi.subVectors(t.center,this.origin);let n=Gi.dot(this.direction),s=Gi.dot(Gi)-n*n,r=t.radius*t.radius;if(s>r)return null;let o=Math.sqrt(r-s),a=n-o,l=n+o;return l<0?null:a<0?this.at(l,e):this.at(a,e)}intersectsSphere(t){return this.distanceSqToPoint(t.center)<=t.radius*t.radius}distanceToPlane(t){let e=t.normal.dot(this.direction);if(e===0)return t.distanceToPoint(this.origin)===0?0:null;let n=-(this.origin.dot(t.normal)+t.constant)/e;return n>=0?n:null}intersectPlane(t,e){let n=this.distanceToPlane(t);return n===null?null:this.at(n,e)}intersectsPlane(t){let e=t.distanceToPoint(this.origin);return e===0||t.normal.dot(this.direction)*e<0}intersectBox(t,e){let n,s,r,o,a,l,c=1/this.direction.x,u=1/this.direction.y,f=1/this.direction.z,h=this.origin;return c>=0?(n=(t.min.x-h.x)*c,s=(t.max.x-h.x)*c):(n=(t.max.x-h.x)*c,s=(t.min.x-h.x)*c),u>=0?(r=(t.min.y-h.y)*u,o=(t.max.y-h.y)*u):(r=(t.max.y-h.y)*u,o=(t.min.y-h.y)*u),n>o||r>s||((r>n||isNaN(n))&&(n=r),(o<s||isNaN(s))&&(s=o),f>=0?(a=(t.min.z-h.z)*f,l=(t.max.z-h.z)*f):(a=(t.max.z-h.z)*f,l=(t.min.z-h.z)*f),n>l||a>s)||((a>n||n!==n)&&(n=a),(l<s||s!==s)&&(s=l),s<0)?null:this.at(n>=0?n:s,e)}intersectsBox(t){return this.intersectBox(t,Gi)!==null}intersectTriangle(t,e,n,s,r){Hc.subVectors(e,t),Ra.subVectors(n,t),Gc.crossVectors(Hc,Ra);let o=this.direction.dot(Gc),a;if(o>0){if(s)return null;a=1}else if(o<0)a=-1,o=-o;else return null;ps.subVectors(this.origin,t);let l=a*this.direction.dot(Ra.crossVectors(ps,Ra));if(l<0)return null;let c=a*this.direction.dot(Hc.cross(ps));if(c<0||l+c>o)return null;let u=-a*ps.dot(Gc);return u<0?null:this.at(u/o,r)}applyMatrix4(t){return this.origin.applyMatrix4(t),this.direction.transformDirection(t),this}equals(t){return t.origin.equals(this.origin)&&t.direction.equals(this.direction)}clone(){return new this.constructor().copy(this)}},Ge=class i{constructor(t,e,n,s,r,o,a,l,c,u,f,h,p,_,g,m){i.prototype.isMatrix4=!0,this.elements=[1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1],t!==void 0&&this.set(t,e,n,s,r,o,a,l,c,u,f,h,p,_,g,m)}set(t,e,n,s,r,o,a,l,c,u,f,h,p,_,g,m){let d=this.elements;return d[0]=t,d[4]=e,d[8]=n,d[12]=s,d[1]=r,d[5]=o,d[9]=a,d[13]=l,d[2]=c,d[6]=u,d[10]=f,d[14]=h,d[3]=p,d[7]=_,d[11]=g,d[15]=m,this}identity(){return this.set(1,0,0,0,0,1,0,0,0,0,1,0,0,0,0,1),this}clone(){return new i().fromArray(this.elements)}copy(t){let e=this.elements,n=t.elements;return e[0]=n[0],e[1]=n[1],e[2]=n[2],e[3]=n[3],e[4]=n[4],e[5]=n[5],e[6]=n[6],e[7]=n[7],e[8]=n[8],e[9]=n[9],e[10]=n[10],e[11]=n[11],e[12]=n[12],e[13]=n[13],e[14]=n[14],e[15]=n[15],this}copyPosition(t){let e=this.elements,n=t.elements;return e[12]=n[12],e[13]=n[13],e[14]=n[14],this}setFromMatrix3(t){let e=t.elements;return this.set(e[0],e[3],e[6],0,e[1],e[4],e[7],0,e[2],e[5],e[8],0,0,0,0,1),this}extractBasis(t,e,n){return t.setFromMatrixColumn(this,0),e.setFromMatrixColumn(this,1),n.setFromMatrixColumn(this,2),this}makeBasis(t,e,n){return this.set(t.x,e.x,n.x,0,t.y,e.y,n.y,0,t.z,e.z,n.z,0,0,0,0,1),this}extractRotation(t){let e=this.elements,n=t.elements,s=1/Dr.setFromMatrixColumn(t,0).length(),r=1/Dr.setFromMatrixColumn(t,1).length(),o=1/Dr.setFromMatrixColumn(t,2).length();return e[0]=n[0]*s,e[1]=n[1]*s,e[2]=n[2]*s,e[3]=0,e[4]=n[4]*r,e[5]=n[5]*r,e[6]=n[6]*r,e[7]=0,e[8]=n[8]*o,e[9]=n[9]*o,e[10]=n[10]*o,e[11]=0,e[12]=0,e[13]=0,e[14]=0,e[15]=1,this}makeRotationFromEuler(t){let e=this.elements,n=t.x,s=t.y,r=t.z,o=Math.cos(n),a=Math.sin(n),l=Math.cos(s),c=Math.sin(s),u=Math.cos(r),f=Math.sin(r);if(t.order==="XYZ"){let h=o*u,p=o*f,_=a*u,g=a*f;e[0]=l*u,e[4]=-l*f,e[8]=c,e[1]=p+_*c,e[5]=h-g*c,e[9]=-a*l,e[2]=g-h*c,e[6]=_+p*c,e[10]=o*l}else if(t.order==="YXZ"){let h=l*u,p=l*f,_=c*u,g=c*f;e[0]=h+g*a,e[4]=_*a-p,e[8]=o*c,e[1]=o*f,e[5]=o*u,e[9]=-a,e[2]=p*a-_,e[6]=g+h*a,e[10]=o*l}else if(t.order==="ZXY"){let h=l*u,p=l*f,_=c*u,g=c*f;e[0]=h-g*a,e[4]=-o*f,e[8]=_+p*a,e[1]=p+_*a,e[5]=o*u,e[9]=g-h*a,e[2]=-o*c,e[6]=a,e[10]=o*l}else if(t.order==="ZYX"){let h=o*u,p=o*f,_=a*u,g=a*f;e[0]=l*u,e[4]=_*c-p,e[8]=h*c+g,e[1]=l*f,e[5]=g*c+h,e[9]=p*c-_,e[2]=-c,e[6]=a*l,e[10]=o*l}else if(t.order==="YZX"){let h=o*l,p=o*c,_=a*l,g=a*c;e[0]=l*u,e[4]=g-h*f,e[8]=_*f+p,e[1]=f,e[5]=o*u,e[9]=-a*u,e[2]=-c*u,e[6]=p*f+_,e[10]=h-g*f}else if(t.order==="XZY"){let h=o*l,p=o*c,_=a*l,g=a*c;e[0]=l*u,e[4]=-f,e[8]=c*u,e[1]=h*f+g,e[5]=o*u,e[9]=p*f-_,e[2]=_*f-p,e[6]=a*u,e[10]=g*f+h}return e[3]=0,e[7]=0,e[11]=0,e[12]=0,e[13]=0,e[14]=0,e[15]=1,this}makeRotationFromQuaternion(t){return this.compose(Ix,t,Lx)}lookAt(t,e,n){let s=this.elements;return Yn.subVectors(t,e),Yn.lengthSq()===0&&(Yn.z=1),Yn.normalize(),ms.crossVectors(n,Yn),ms.lengthSq()===0&&(Math.abs(n.z)===1?Yn.x+=1e-4:Yn.z+=1e-4,Yn.normalize(),ms.crossVectors(n,Yn)),ms.normalize(),Pa.crossVectors(Yn,ms),s[0]=ms.x,s[4]=Pa.x,s[8]=Yn.x,s[1]=ms.y,s[5]=Pa.y,s[9]=Yn.y,s[2]=ms.z,s[6]=Pa.z,s[10]=Yn.z,this}multiply(t){return this.multiplyMatrices(this,t)}premultiply(t){return this.multiplyMatrices(t,this)}multiplyMatrices(t,e){let n=t.elements,s=e.elements,r=this.elements,o=n[0],a=n[4],l=n[8],c=n[12],u=n[1],f=n[5],h=n[9],p=n[13],_=n[2],g=n[6],m=n[10],d=n[14],S=n[3],v=n[7],y=n[11],I=n[15],C=s[0],R=s[4],L=s[8],E=s[12],b=s[1],A=s[5],O=s[9],F=s[13],G=s[2],$=s[6],W=s[10],Z=s[14],J=s[3],ct=s[7],lt=s[11],_t=s[15];return r[0]=o*C+a*b+l*G+c*J,r[4]=o*R+a*A+l*$+c*ct,r[8]=o*L+a*O+l*W+c*lt,r[12]=o*E+a*F+l*Z+c*_t,r[1]=u*C+f*b+h*G+p*J,r[5]=u*R+f*A+h*$+p*ct,r[9]=u*L+f*O+h*W+p*lt,r[13]=u*E+f*F+h*Z+p*_t,r[2]=_*C+g*b+m*G+d*J,r[6]=_*R+g*A+m*$+d*ct,r[10]=_*L+g*O+m*W+d*lt,r[14]=_*E+g*F+m*Z+d*_t,r[3]=S*C+v*b+y*G+I*J,r[7]=S*R+v*A+y*$+I*ct,r[11]=S*L+v*O+y*W+I*lt,r[15]=S*E+v*F+y*Z+I*_t,this}multiplyScalar(t){let e=this.elements;return e[0]*=t,e[4]*=t,e[8]*=t,e[12]*=t,e[1]*=t,e[5]*=t,e[9]*=t,e[13]*=t,e[2]*=t,e[6]*=t,e[10]*=t,e[14]*=t,e[3]*=t,e[7]*=t,e[11]*=t,e[15]*=t,this}determinant(){let t=this.elements,e=t[0],n=t[4],s=t[8],r=t[12],o=t[1],a=t[5],l=t[9],c=t[13],u=t[2],f=t[6],h=t[10],p=t[14],_=t[3],g=t[7],m=t[11],d=t[15];return _*(+r*l*f-s*c*f-r*a*h+n*c*h+s*a*p-n*l*p)+g*(+e*l*p-e*c*h+r*o*h-s*o*p+s*c*u-r*l*u)+m*(+e*c*f-e*a*p-r*o*f+n*o*p+r*a*u-n*c*u)+d*(-s*a*u-e*l*f+e*a*h+s*o*f-n*o*h+n*l*u)}transpose(){let t=this.elements,e;return e=t[1],t[1]=t[4],t[4]=e,e=t[2],t[2]=t[8],t[8]=e,e=t[6],t[6]=t[9],t[9]=e,e=t[3],t[3]=t[12],t[12]=e,e=t[7],t[7]=t[13],t[13]=e,e=t[11],t[11]=t[14],t[14]=e,this}setPosition(t,e,n){let s=this.elements;return t.isVector3?(s[12]=t.x,s[13]=t.y,s[14]=t.z):(s[12]=t,s[13]=e,s[14]=n),this}invert(){let t=this.elements,e=t[0],n=t[1],s=t[2],r=t[3],o=t[4],a=t[5],l=t[6],c=t[7],u=t[8],f=t[9],h=t[10],p=t[11],_=t[12],g=t[13],m=t[14],d=t[15],S=f*m*c-g*h*c+g*l*p-a*m*p-f*l*d+a*h*d,v=_*h*c-u*m*c-_*l*p+o*m*p+u*l*d-o*h*d,y=u*g*c-_*f*c+_*a*p-o*g*p-u*a*d+o*f*d,I=_*f*l-u*g*l-_*a*h+o*g*h+u*a*m-o*f*m,C=e*S+n*v+s*y+r*I;if(C===0)return this.set(0,0,0,0,0,0,0,0,0,0,0,0,0,0,0,0);let R=1/C;return t[0]=S*R,t[1]=(g*h*r-f*m*r-g*s*p+n*m*p+f*s*d-n*h*d)*R,t[2]=(a*m*r-g*l*r+g*s*c-n*m*c-a*s*d+n*l*d)*R,t[3]=(f*l*r-a*h*r-f*s*c+n*h*c+a*s*p-n*l*p)*R,t[4]=v*R,t[5]=(u*m*r-_*h*r+_*s*p-e*m*p-u*s*d+e*h*d)*R,t[6]=(_*l*r-o*m*r-_*s*c+e*m*c+o*s*d-e*l*d)*R,t[7]=(o*h*r-u*l*r+u*s*c-e*h*c-o*s*p+e*l*p)*R,t[8]=y*R,t[9]=(_*f*r-u*g*r-_*n*p+e*g*p+u*n*d-e*f*d)*R,t[10]=(o*g*r-_*a*r+_*n*c-e*g*c-o*n*d+e*a*d)*R,t[11]=(u*a*r-o*f*r-u*n*c+e*f*c+o*n*p-e*a*p)*R,t[12]=I*R,t[13]=(u*g*s-_*f*s+_*n*h-e*g*h-u*n*m+e*f*m)*R,t[14]=(_*a*s-o*g*s-_*n*l+e*g*l+o*n*m-e*a*m)*R,t[15]=(o*f*s-u*a*s+u*n*l-e*f*l-o*n*h+e*a*h)*R,this}scale(t){let e=this.elements,n=t.x,s=t.y,r=t.z;return e[0]*=n,e[4]*=s,e[8]*=r,e[1]*=n,e[5]*=s,e[9]*=r,e[2]*=n,e[6]*=s,e[10]*=r,e[3]*=n,e[7]*=s,e[11]*=r,this}getMaxScaleOnAxis(){let t=this.elements,e=t[0]*t[0]+t[1]*t[1]+t[2]*t[2],n=t[4]*t[4]+t[5]*t[5]+t[6]*t[6],s=t[8]*t[8]+t[9]*t[9]+t[10]*t[10];return Math.sqrt(Math.max(e,n,s))}makeTranslation(t,e,n){return t.isVector3?this.set(1,0,0,t.x,0,1,0,t.y,0,0,1,t.z,0,0,0,1):this.set(1,0,0,t,0,1,0,e,0,0,1,n,0,0,0,1),this}makeRotationX(t){let e=Math.cos(t),n=Math.sin(t);return this.set(1,0,0,0,0,e,-n,0,0,n,e,0,0,0,0,1),this}makeRotationY(t){let e=Math.cos(t),n=Math.sin(t);return this.set(e,0,n,0,0,1,0,0,-n,0,e,0,0,0,0,1),this}makeRotationZ(t){let e=Math.cos(t),n=Math.sin(t);return this.set(e,-n,0,0,n,e,0,0,0,0,1,0,0,0,0,1),this}makeRotationAxis(t,e){let n=Math.cos(e),s=Math.sin(e),r=1-n,o=t.x,a=t.y,l=t.z,c=r*o,u=r*a;return this.set(c*o+n,c*a-s*l,c*l+s*a,0,c*a+s*l,u*a+n,u*l-s*o,0,c*l-s*a,u*l+s*o,r*l*l+n,0,0,0,0,1),this}makeScale(t,e,n){return this.set(t,0,0,0,0,e,0,0,0,0,n,0,0,0,0,1),this}makeShear(t,e,n,s,r,o){return this.set(1,n,r,0,t,1,o,0,e,s,1,0,0,0,0,1),this}compose(t,e,n){let s=this.elements,r=e._x,o=e._y,a=e._z,l=e._w,c=r+r,u=o+o,f=a+a,h=r*c,p=r*u,_=r*f,g=o*u,m=o*f,d=a*f,S=l*c,v=l*u,y=l*f,I=n.x,C=n.y,R=n.z;return s[0]=(1-(g+d))*I,s[1]=(p+y)*I,s[2]=(_-v)*I,s[3]=0,s[4]=(p-y)*C,s[5]=(1-(h+d))*C,s[6]=(m+S)*C,s[7]=0,s[8]=(_+v)*R,s[9]=(m-S)*R,s[10]=(1-(h+g))*R,s[11]=0,s[12]=t.x,s[13]=t.y,s[14]=t.z,s[15]=1,this}decompose(t,e,n){let s=this.elements,r=Dr.set(s[0],s[1],s[2]).length(),o=Dr.set(s[4],s[5],s[6]).length(),a=Dr.set(s[8],s[9],s[10]).length();this.determinant()<0&&(r=-r),t.x=s[12],t.y=s[13],t.z=s[14],pi.copy(this);let c=1/r,u=1/o,f=1/a;return pi.elements[0]*=c,pi.elements[1]*=c,pi.elements[2]*=c,pi.elements[4]*=u,pi.elements[5]*=u,pi.elements[6]*=u,pi.elements[8]*=f,pi.elements[9]*=f,pi.elements[10]*=f,e.setFromRotationMatrix(pi),n.x=r,n.y=o,n.z=a,this}makePerspective(t,e,n,s,r,o,a=Zi){let l=this.elements,c=2*r/(e-t),u=2*r/(n-s),f=(e+t)/(e-t),h=(n+s)/(n-s),p,_;if(a===Zi)p=-(o+r)/(o-r),_=-2*o*r/(o-r);else if(a===tl)p=-o/(o-r),_=-o*r/(o-r);else throw new Error("THREE.Matrix4.makePerspective(): Invalid coordinate system: "+a);return l[0]=c,l[4]=0,l[8]=f,l[12]=0,l[1]=0,l[5]=u,l[9]=h,l[13]=0,l[2]=0,l[6]=0,l[10]=p,l[14]=_,l[3]=0,l[7]=0,l[11]=-1,l[15]=0,this}makeOrthographic(t,e,n,s,r,o,a=Zi){let l=this.elements,c=1/(e-t),u=1/(n-s),f=1/(o-r),h=(e+t)*c,p=(n+s)*u,_,g;if(a===Zi)_=(o+r)*f,g=-2*f;else if(a===tl)_=r*f,g=-1*f;else throw new Error("THREE.Matrix4.makeOrthographic(): Invalid coordinate system: "+a);return l[0]=2*c,l[4]=0,l[8]=0,l[12]=-h,l[1]=0,l[5]=2*u,l[9]=0,l[13]=-p,l[2]=0,l[6]=0,l[10]=g,l[14]=-_,l[3]=0,l[7]=0,l[11]=0,l[15]=1,this}equals(t){let e=this.elements,n=t.elements;for(let s=0;s<16;s++)if(e[s]!==n[s])return!1;return!0}fromArray(t,e=0){for(let n=0;n<16;n++)this.elements[n]=t[n+e];return this}toArray(t=[],e=0){let n=this.elements;return t[e]=n[0],t[e+1]=n[1],t[e+2]=n[2],t[e+3]=n[3],t[e+4]=n[4],t[e+5]=n[5],t[e+6]=n[6],t[e+7]=n[7],t[e+8]=n[8],t[e+9]=n[9],t[e+10]=n[10],t[e+11]=n[11],t[e+12]=n[12],t[e+13]=n[13],t[e+14]=n[14],t[e+15]=n[15],t}},Dr=new Y,pi=new Ge,Ix=new Y(0,0,0),Lx=new Y(1,1,1),ms=new Y,Pa=new Y,Yn=new Y,wp=new Ge,Ep=new yi,Li=class i{constructor(t=0,e=0,n=0,s=i.DEFAULT_ORDER){this.isEuler=!0,this._x=t,this._y=e,this._z=n,this._order=s}get x(){return this._x}set x(t){this._x=t,this._onChangeCallback()}get y(){return this._y}set y(t){this._y=t,this._onChangeCallback()}get z(){return this._z}set z(t){this._z=t,this._onChangeCallback()}get order(){return this._order}set order(t){this._order=t,this._onChangeCallback()}set(t,e,n,s=this._order){return this._x=t,this._y=e,this._z=n,this._order=s,this._onChangeCallback(),this}clone(){return new this.constructor(this._x,this._y,this._z,this._order)}copy(t){return this._x=t._x,this._y=t._y,this._z=t._z,this._order=t._order,this._onChangeCallback(),this}setFromRotationMatrix(t,e=this._order,n=!0){let s=t.elements,r=s[0],o=s[4],a=s[8],l=s[1],c=s[5],u=s[9],f=s[2],h=s[6],p=s[10];switch(e){case"XYZ":this._y=Math.asin(xn(a,-1,1)),Math.abs(a)<.9999999?(this._x=Math.atan2(-u,p),this._z=Math.atan2(-o,r)):(this._x=Math.atan2(h,c),this._z=0);break;case"YXZ":this._x=Math.asin(-xn(u,-1,1)),Math.abs(u)<.9999999?(this._y=Math.atan2(a,p),this._z=Math.atan2(l,c)):(this._y=Math.atan2(-f,r),this._z=0);break;case"ZXY":this._x=Math.asin(xn(h,-1,1)),Math.abs(h)<.9999999?(this._y=Math.atan2(-f,p),this._z=Math.atan2(-o,c)):(this._y=0,this._z=Math.atan2(l,r));break;case"ZYX":this._y=Math.asin(-xn(f,-1,1)),Math.abs(f)<.9999999?(this._x=Math.atan2(h,p),this._z=Math.atan2(l,r)):(this._x=0,this._z=Math.atan2(-o,c));break;case"YZX":this._z=Math.asin(xn(l,-1,1)),Math.abs(l)<.9999999?(this._x=Math.atan2(-u,c),this._y=Math.atan2(-f,r)):(this._x=0,this._y=Math.atan2(a,p));break;case"XZY":this._z=Math.asin(-xn(o,-1,1)),Math.abs(o)<.9999999?(this._x=Math.atan2(h,c),this._y=Math.atan2(a,r)):(this._x=Math.atan2(-u,p),this._y=0);break;default:console.warn("THREE.Euler: .setFromRotationMatrix() encountered an unknown order: "+e)}return this._order=e,n===!0&&this._onChangeCallback(),this}setFromQuaternion(t,e,n){return wp.makeRotationFromQuaternion(t),this.setFromRotationMatrix(wp,e,n)}setFromVector3(t,e=this._order){return this.set(t.x,t.y,t.z,e)}reorder(t){return Ep.setFromEuler(this),this.setFromQuaternion(Ep,t)}equals(t){return t._x===this._x&&t._y===this._y&&t._z===this._z&&t._order===this._order}fromArray(t){return this._x=t[0],this._y=t[1],this._z=t[2],t[3]!==void 0&&(this._order=t[3]),this._onChangeCallback(),this}toArray(t=[],e=0){return t[e]=this._x,t[e+1]=this._y,t[e+2]=this._z,t[e+3]=this._order,t}_onChange(t){return this._onChangeCallback=t,this}_onChangeCallback(){}*[Symbol.iterator](){yield this._x,yield this._y,yield this._z,yield this._order}};Li.DEFAULT_ORDER="XYZ";var sl=class{constructor(){this.mask=1}set(t){this.mask=(1<<t|0)>>>0}enable(t){this.mask|=1<<t|0}enableAll(){this.mask=-1}toggle(t){this.mask^=1<<t|0}disable(t){this.mask&=~(1<<t|0)}disableAll(){this.mask=0}test(t){return(this.mask&t.mask)!==0}isEnabled(t){return(this.mask&(1<<t|0))!==0}},Dx=0,Tp=new Y,Ur=new yi,Wi=new Ge,Ia=new Y,Po=new Y,Ux=new Y,Nx=new yi,Ap=new Y(1,0,0),Cp=new Y(0,1,0),Rp=new Y(0,0,1),Pp={type:"added"},Ox={type:"removed"},Nr={type:"childadded",child:null},Wc={type:"childremoved",child:null},Rn=class i extends Qi{constructor(){super(),this.isObject3D=!0,Object.defineProperty(this,"id",{value:Dx++}),this.uuid=oo(),this.name="",this.type="Object3D",this.parent=null,this.children=[],this.up=i.DEFAULT_UP.clone();let t=new Y,e=new Li,n=new yi,s=new Y(1,1,1);function r(){n.setFromEuler(e,!1)}function o(){e.setFromQuaternion(n,void 0,!1)}e._onChange(r),n._onChange(o),Object.defineProperties(this,{position:{configurable:!0,enumerable:!0,value:t},rotation:{configurable:!0,enumerable:!0,value:e},quaternion:{configurable:!0,enumerable:!0,value:n},scale:{configurable:!0,enumerable:!0,value:s},modelViewMatrix:{value:new Ge},normalMatrix:{value:new oe}}),this.matrix=new Ge,this.matrixWorld=new Ge,this.matrixAutoUpdate=i.DEFAULT_MATRIX_AUTO_UPDATE,this.matrixWorldAutoUpdate=i.DEFAULT_MATRIX_WORLD_AUTO_UPDATE,this.matrixWorldNeedsUpdate=!1,this.layers=new sl,this.visible=!0,this.castShadow=!1,this.receiveShadow=!1,this.frustumCulled=!0,this.renderOrder=0,this.animations=[],this.userData={}}onBeforeShadow(){}onAfterShadow(){}onBeforeRender(){}onAfterRender(){}applyMatrix4(t){this.matrixAutoUpdate&&this.updateMatrix(),this.matrix.premultiply(t),this.matrix.decompose(this.position,this.quaternion,this.scale)}applyQuaternion(t){return this.quaternion.premultiply(t),this}setRotationFromAxisAngle(t,e){this.quaternion.setFromAxisAngle(t,e)}setRotationFromEuler(t){this.quaternion.setFromEuler(t,!0)}setRotationFromMatrix(t){this.quaternion.setFromRotationMatrix(t)}setRotationFromQuaternion(t){this.quaternion.copy(t)}rotateOnAxis(t,e){return Ur.setFromAxisAngle(t,e),this.quaternion.multiply(Ur),this}rotateOnWorldAxis(t,e){return Ur.setFromAxisAngle(t,e),this.quaternion.premultiply(Ur),this}rotateX(t){return this.rotateOnAxis(Ap,t)}rotateY(t){return this.rotateOnAxis(Cp,t)}rotateZ(t){return this.rotateOnAxis(Rp,t)}translateOnAxis(t,e){return Tp.copy(t).applyQuaternion(this.quaternion),this.position.add(Tp.multiplyScalar(e)),this}translateX(t){return this.translateOnAxis(Ap,t)}translateY(t){return this.translateOnAxis(Cp,t)}translateZ(t){return this.translateOnAxis(Rp,t)}localToWorld(t){return this.updateWorldMatrix(!0,!1),t.applyMatrix4(this.matrixWorld)}worldToLocal(t){return this.updateWorldMatrix(!0,!1),t.applyMatrix4(Wi.copy(this.matrixWorld).invert())}lookAt(t,e,n){t.isVector3?Ia.copy(t):Ia.set(t,e,n);let s=this.parent;this.updateWorldMatrix(!0,!1),Po.setFromMatrixPosition(this.matrixWorld),this.isCamera||this.isLight?Wi.lookAt(Po,Ia,this.up):Wi.lookAt(Ia,Po,this.up),this.quaternion.setFromRotationMatrix(Wi),s&&(Wi.extractRotation(s.matrixWorld),Ur.setFromRotationMatrix(Wi),this.quaternion.premultiply(Ur.invert()))}add(t){if(arguments.length>1){for(let e=0;e<arguments.length;e++)this.add(arguments[e]);return this}return t===this?(console.error("THREE.Object3D.add: object can't be added as a child of itself.",t),this):(t&&t.isObject3D?(t.removeFromParent(),t.parent=this,this.children.push(t),t.dispatchEvent(Pp),Nr.child=t,this.dispatchEvent(Nr),Nr.child=null):console.error("THREE.Object3D.add: object not an instance of THREE.Object3D.",t),this)}remove(t){if(arguments.length>1){for(let n=0;n<arguments.length;n++)this.remove(arguments[n]);return this}let e=this.children.indexOf(t);return e!==-1&&(t.parent=null,this.children.splice(e,1),t.dispatchEvent(Ox),Wc.child=t,this.dispatchEvent(Wc),Wc.child=null),this}removeFromParent(){let t=this.parent;return t!==null&&t.remove(this),this}clear(){return this.remove(...this.children)}attach(t){return this.updateWorldMatrix(!0,!1),Wi.copy(this.matrixWorld).invert(),t.parent!==null&&(t.parent.updateWorldMatrix(!0,!1),Wi.multiply(t.parent.matrixWorld)),t.applyMatrix4(Wi),t.removeFromParent(),t.parent=this,this.children.push(t),t.updateWorldMatrix(!1,!0),t.dispatchEvent(Pp),Nr.child=t,this.dispatchEvent(Nr),Nr.child=null,this}getObjectById(t){return this.getObjectByProperty("id",t)}getObjectByName(t){return this.getObjectByProperty("name",t)}getObjectByProperty(t,e){if(this[t]===e)return this;for(let n=0,s=this.children.length;n<s;n++){let o=this.children[n].getObjectByProperty(t,e);if(o!==void 0)return o}}getObjectsByProperty(t,e,n=[]){this[t]===e&&n.push(this);let s=this.children;for(let r=0,o=s.length;r<o;r++)s[r].getObjectsByProperty(t,e,n);return n}getWorldPosition(t){return this.updateWorldMatrix(!0,!1),t.setFromMatrixPosition(this.matrixWorld)}getWorldQuaternion(t){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Po,t,Ux),t}getWorldScale(t){return this.updateWorldMatrix(!0,!1),this.matrixWorld.decompose(Po,Nx,t),t}getWorldDirection(t){this.updateWorldMatrix(!0,!1);let e=this.matrixWorld.elements;return t.set(e[8],e[9],e[10]).normalize()}raycast(){}traverse(t){t(this);let e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].traverse(t)}traverseVisible(t){if(this.visible===!1)return;t(this);let e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].traverseVisible(t)}traverseAncestors(t){let e=this.parent;e!==null&&(t(e),e.traverseAncestors(t))}updateMatrix(){this.matrix.compose(this.position,this.quaternion,this.scale),this.matrixWorldNeedsUpdate=!0}updateMatrixWorld(t){this.matrixAutoUpdate&&this.updateMatrix(),(this.matrixWorldNeedsUpdate||t)&&(this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),this.matrixWorldNeedsUpdate=!1,t=!0);let e=this.children;for(let n=0,s=e.length;n<s;n++)e[n].updateMatrixWorld(t)}updateWorldMatrix(t,e){let n=this.parent;if(t===!0&&n!==null&&n.updateWorldMatrix(!0,!1),this.matrixAutoUpdate&&this.updateMatrix(),this.matrixWorldAutoUpdate===!0&&(this.parent===null?this.matrixWorld.copy(this.matrix):this.matrixWorld.multiplyMatrices(this.parent.matrixWorld,this.matrix)),e===!0){let s=this.children;for(let r=0,o=s.length;r<o;r++)s[r].updateWorldMatrix(!1,!0)}}toJSON(t){let e=t===void 0||typeof t=="string",n={};e&&(t={geometries:{},materials:{},textures:{},images:{},shapes:{},skeletons:{},animations:{},nodes:{}},n.metadata={version:4.6,type:"Object",generator:"Object3D.toJSON"});let s={};s.uuid=this.uuid,s.type=this.type,this.name!==""&&(s.name=this.name),this.castShadow===!0&&(s.castShadow=!0),this.receiveShadow===!0&&(s.receiveShadow=!0),this.visible===!1&&(s.visible=!1),this.frustumCulled===!1&&(s.frustumCulled=!1),this.renderOrder!==0&&(s.renderOrder=this.renderOrder),Object.keys(this.userData).length>0&&(s.userData=this.userData),s.layers=this.layers.mask,s.matrix=this.matrix.toArray(),s.up=this.up.toArray(),this.matrixAutoUpdate===!1&&(s.matrixAutoUpdate=!1),this.isInstancedMesh&&(s.type="InstancedMesh",s.count=this.count,s.instanceMatrix=this.instanceMatrix.toJSON(),this.instanceColor!==null&&(s.instanceColor=this.instanceColor.toJSON())),this.isBatchedMesh&&(s.type="BatchedMesh",s.perObjectFrustumCulled=this.perObjectFrustumCulled,s.sortObjects=this.sortObjects,s.drawRanges=this._drawRanges,s.reservedRanges=this._reservedRanges,s.visibility=this._visibility,s.active=this._active,s.bounds=this._bounds.map(a=>({boxInitialized:a.boxInitialized,boxMin:a.box.min.toArray(),boxMax:a.box.max.toArray(),sphereInitialized:a.sphereInitialized,sphereRadius:a.sphere.radius,sphereCenter:a.sphere.center.toArray()})),s.maxInstanceCount=this._maxInstanceCount,s.maxVertexCount=this._maxVertexCount,s.maxIndexCount=this._maxIndexCount,s.geometryInitialized=this._geometryInitialized,s.geometryCount=this._geometryCount,s.matricesTexture=this._matricesTexture.toJSON(t),this._colorsTexture!==null&&(s.colorsTexture=this._colorsTexture.toJSON(t)),this.boundingSphere!==null&&(s.boundingSphere={center:s.boundingSphere.center.toArray(),radius:s.boundingSphere.radius}),this.boundingBox!==null&&(s.boundingBox={min:s.boundingBox.min.toArray(),max:s.boundingBox.max.toArray()}));function r(a,l){return a[l.uuid]===void 0&&(a[l.uuid]=l.toJSON(t)),l.uuid}if(this.isScene)this.background&&(this.background.isColor?s.background=this.background.toJSON():this.background.isTexture&&(s.background=this.background.toJSON(t).uuid)),this.environment&&this.environment.isTexture&&this.environment.isRenderTargetTexture!==!0&&(s.environment=this.environment.toJSON(t).uuid);else if(this.isMesh||this.isLine||this.isPoints){s.geometry=r(t.geometries,this.geometry);let a=this.geometry.parameters;if(a!==void 0&&a.shapes!==void 0){let l=a.shapes;if(Array.isArray(l))for(let c=0,u=l.length;c<u;c++){let f=l[c];r(t.shapes,f)}else r(t.shapes,l)}}if(this.isSkinnedMesh&&(s.bindMode=this.bindMode,s.bindMatrix=this.bindMatrix.toArray(),this.skeleton!==void 0&&(r(t.skeletons,this.skeleton),s.skeleton=this.skeleton.uuid)),this.material!==void 0)if(Array.isArray(this.material)){let a=[];for(let l=0,c=this.material.length;l<c;l++)a.push(r(t.materials,this.material[l]));s.material=a}else s.material=r(t.materials,this.material);if(this.children.length>0){s.children=[];for(let a=0;a<this.children.length;a++)s.children.push(this.children[a].toJSON(t).object)}if(this.animations.length>0){s.animations=[];for(let a=0;a<this.animations.length;a++){let l=this.animations[a];s.animations.push(r(t.animations,l))}}if(e){let a=o(t.geometries),l=o(t.materials),c=o(t.textures),u=o(t.images),f=o(t.shapes),h=o(t.skeletons),p=o(t.animations),_=o(t.nodes);a.length>0&&(n.geometries=a),l.length>0&&(n.materials=l),c.length>0&&(n.textures=c),u.length>0&&(n.images=u),f.length>0&&(n.shapes=f),h.length>0&&(n.skeletons=h),p.length>0&&(n.animations=p),_.length>0&&(n.nodes=_)}return n.object=s,n;function o(a){let l=[];for(let c in a){let u=a[c];delete u.metadata,l.push(u)}return l}}clone(t){return new this.constructor().copy(this,t)}copy(t,e=!0){if(this.name=t.name,this.up.copy(t.up),this.position.copy(t.position),this.rotation.order=t.rotation.order,this.quaternion.copy(t.quaternion),this.scale.copy(t.scale),this.matrix.copy(t.matrix),this.matrixWorld.copy(t.matrixWorld),this.matrixAutoUpdate=t.matrixAutoUpdate,this.matrixWorldAutoUpdate=t.matrixWorldAutoUpdate,this.matrixWorldNeedsUpdate=t.matrixWorldNeedsUpdate,this.layers.mask=t.layers.mask,this.visible=t.visible,this.castShadow=t.castShadow,this.receiveShadow=t.receiveShadow,this.frustumCulled=t.frustumCulled,this.renderOrder=t.renderOrder,this.animations=t.animations.slice(),this.userData=JSON.parse(JSON.stringify(t.userData)),e===!0)for(let n=0;n<t.children.length;n++){let s=t.children[n];this.add(s.clone())}return this}};Rn.DEFAULT_UP=new Y(0,1,0);Rn.DEFAULT_MATRIX_AUTO_UPDATE=!0;Rn.DEFAULT_MATRIX_WORLD_AUTO_UPDATE=!0;var mi=new Y,Xi=new Y,Xc=new Y,qi=new Y,Or=new Y,Fr=new Y,Ip=new Y,qc=new Y,Yc=new Y,$c=new Y,Zc=new He,Jc=new He,Kc=new He,Ys=class i{constructor(t=new Y,e=new Y,n=new Y){this.a=t,this.b=e,this.c=n}static getNormal(t,e,n,s){s.subVectors(n,e),mi.subVectors(t,e),s.cross(mi);let r=s.lengthSq();return r>0?s.multiplyScalar(1/Math.sqrt(r)):s.set(0,0,0)}static getBarycoord(t,e,n,s,r){mi.subVectors(s,e),Xi.subVectors(n,e),Xc.subVectors(t,e);let o=mi.dot(mi),a=mi.dot(Xi),l=mi.dot(Xc),c=Xi.dot(Xi),u=Xi.dot(Xc),f=o*c-a*a;if(f===0)return r.set(0,0,0),null;let h=1/f,p=(c*l-a*u)*h,_=(o*u-a*l)*h;return r.set(1-p-_,_,p)}static containsPoint(t,e,n,s){return this.getBarycoord(t,e,n,s,qi)===null?!1:qi.x>=0&&qi.y>=0&&qi.x+qi.y<=1}static getInterpolation(t,e,n,s,r,o,a,l){return this.getBarycoord(t,e,n,s,qi)===null?(l.x=0,l.y=0,"z"in l&&(l.z=0),"w"in l&&(l.w=0),null):(l.setScalar(0),l.addScaledVector(r,qi.x),l.addScaledVector(o,qi.y),l.addScaledVector(a,qi.z),l)}static getInterpolatedAttribute(t,e,n,s,r,o){return Zc.setScalar(0),Jc.setScalar(0),Kc.setScalar(0),Zc.fromBufferAttribute(t,e),Jc.fromBufferAttribute(t,n),Kc.fromBufferAttribute(t,s),o.setScalar(0),o.addScaledVector(Zc,r.x),o.addScaledVector(Jc,r.y),o.addScaledVector(Kc,r.z),o}static isFrontFacing(t,e,n,s){return mi.subVectors(n,e),Xi.subVectors(t,e),mi.cross(Xi).dot(s)<0}set(t,e,n){return this.a.copy(t),this.b.copy(e),this.c.copy(n),this}setFromPointsAndIndices(t,e,n,s){return this.a.copy(t[e]),this.b.copy(t[n]),this.c.copy(t[s]),this}setFromAttributeAndIndices(t,e,n,s){return this.a.fromBufferAttribute(t,e),this.b.fromBufferAttribute(t,n),this.c.fromBufferAttribute(t,s),this}clone(){return new this.constructor().copy(this)}copy(t){return this.a.copy(t.a),this.b.copy(t.b),this.c.copy(t.c),this}getArea(){return mi.subVectors(this.c,this.b),Xi.subVectors(this.a,this.b),mi.cross(Xi).length()*.5}getMidpoint(t){return t.addVectors(this.a,this.b).add(this.c).multiplyScalar(1/3)}getNormal(t){return i.getNormal(this.a,this.b,this.c,t)}getPlane(t){return t.setFromCoplanarPoints(this.a,this.b,this.c)}getBarycoord(t,e){return i.getBarycoord(t,this.a,this.b,this.c,e)}getInterpolation(t,e,n,s,r){return i.getInterpolation(t,this.a,this.b,this.c,e,n,s,r)}containsPoint(t){return i.containsPoint(t,this.a,this.b,this.c)}isFrontFacing(t){return i.isFrontFacing(this.a,this.b,this.c,t)}intersectsBox(t){return t.intersectsTriangle(this)}closestPointToPoint(t,e){let n=this.a,s=this.b,r=this.c,o,a;Or.subVectors(s,n),Fr.subVectors(r,n),qc.subVectors(t,n);let l=Or.dot(qc),c=Fr.dot(qc);if(l<=0&&c<=0)return e.copy(n);Yc.subVectors(t,s);let u=Or.dot(Yc),f=Fr.dot(Yc);if(u>=0&&f<=u)return e.copy(s);let h=l*f-u*c;if(h<=0&&l>=0&&u<=0)return o=l/(l-u),e.copy(n).addScaledVector(Or,o);$c.subVectors(t,r);let p=Or.dot($c),_=Fr.dot($c);if(_>=0&&p<=_)return e.copy(r);let g=p*c-l*_;if(g<=0&&c>=0&&_<=0)return a=c/(c-_),e.copy(n).addScaledVector(Fr,a);let m=u*_-p*f;if(m<=0&&f-u>=0&&p-_>=0)return Ip.subVectors(r,s),a=(f-u)/(f-u+(p-_)),e.copy(s).addScaledVector(Ip,a);let d=1/(m+g+h);return o=g*d,a=h*d,e.copy(n).addScaledVector(Or,o).addScaledVector(Fr,a)}equals(t){return t.a.equals(this.a)&&t.b.equals(this.b)&&t.c.equals(this.c)}},Pm={aliceblue:15792383,antiquewhite:16444375,aqua:65535,aquamarine:8388564,azure:15794175,beige:16119260,bisque:16770244,black:0,blanchedalmond:16772045,blue:255,blueviolet:9055202,brown:10824234,burlywood:14596231,cadetblue:6266528,chartreuse:8388352,chocolate:13789470,coral:16744272,cornflowerblue:6591981,cornsilk:16775388,crimson:14423100,cyan:65535,darkblue:139,darkcyan:35723,darkgoldenrod:12092939,darkgray:11119017,darkgreen:25600,darkgrey:11119017,darkkhaki:12433259,darkmagenta:9109643,darkolivegreen:5597999,darkorange:16747520,darkorchid:10040012,darkred:9109504,darksalmon:15308410,darkseagreen:9419919,darkslateblue:4734347,darkslategray:3100495,darkslategrey:3100495,darkturquoise:52945,darkviolet:9699539,deeppink:16716947,deepskyblue:49151,dimgray:6908265,dimgrey:6908265,dodgerblue:2003199,firebrick:11674146,floralwhite:16775920,forestgreen:2263842,fuchsia:16711935,gainsboro:14474460,ghostwhite:16316671,gold:16766720,goldenrod:14329120,gray:8421504,green:32768,greenyellow:11403055,grey:8421504,honeydew:15794160,hotpink:16738740,indianred:13458524,indigo:4915330,ivory:16777200,khaki:15787660,lavender:15132410,lavenderblush:16773365,lawngreen:8190976,lemonchiffon:16775885,lightblue:11393254,lightcoral:15761536,lightcyan:14745599,lightgoldenrodyellow:16448210,lightgray:13882323,lightgreen:9498256,lightgrey:13882323,lightpink:16758465,lightsalmon:16752762,lightseagreen:2142890,lightskyblue:8900346,lightslategray:7833753,lightslategrey:7833753,lightsteelblue:11584734,lightyellow:16777184,lime:65280,limegreen:3329330,linen:16445670,magenta:16711935,maroon:8388608,mediumaquamarine:6737322,mediumblue:205,mediumorchid:12211667,mediumpurple:9662683,mediumseagreen:3978097,mediumslateblue:8087790,mediumspringgreen:64154,mediumturquoise:4772300,mediumvioletred:13047173,midnightblue:1644912,mintcream:16121850,mistyrose:16770273,moccasin:16770229,navajowhite:16768685,navy:128,oldlace:16643558,olive:8421376,olivedrab:7048739,orange:16753920,orangered:16729344,orchid:14315734,palegoldenrod:15657130,palegreen:10025880,paleturquoise:11529966,palevioletred:14381203,papayawhip:16773077,peachpuff:16767673,peru:13468991,pink:16761035,plum:14524637,powderblue:11591910,purple:8388736,rebeccapurple:6697881,red:16711680,rosybrown:12357519,royalblue:4286945,saddlebrown:9127187,salmon:16416882,sandybrown:16032864,seagreen:3050327,seashell:16774638,sienna:10506797,silver:12632256,skyblue:8900331,slateblue:6970061,slategray:7372944,slategrey:7372944,snow:16775930,springgreen:65407,steelblue:4620980,tan:13808780,teal:32896,thistle:14204888,tomato:16737095,turquoise:4251856,violet:15631086,wheat:16113331,white:16777215,whitesmoke:16119285,yellow:16776960,yellowgreen:10145074},gs={h:0,s:0,l:0},La={h:0,s:0,l:0};function jc(i,t,e){return e<0&&(e+=1),e>1&&(e-=1),e<1/6?i+(t-i)*6*e:e<1/2?t:e<2/3?i+(t-i)*6*(2/3-e):i}var pe=class{constructor(t,e,n){return this.isColor=!0,this.r=1,this.g=1,this.b=1,this.set(t,e,n)}set(t,e,n){if(e===void 0&&n===void 0){let s=t;s&&s.isColor?this.copy(s):typeof s=="number"?this.setHex(s):typeof s=="string"&&this.setStyle(s)}else this.setRGB(t,e,n);return this}setScalar(t){return this.r=t,this.g=t,this.b=t,this}setHex(t,e=Un){return t=Math.floor(t),this.r=(t>>16&255)/255,this.g=(t>>8&255)/255,this.b=(t&255)/255,ye.toWorkingColorSpace(this,e),this}setRGB(t,e,n,s=ye.workingColorSpace){return this.r=t,this.g=e,this.b=n,ye.toWorkingColorSpace(this,s),this}setHSL(t,e,n,s=ye.workingColorSpace){if(t=Iu(t,1),e=xn(e,0,1),n=xn(n,0,1),e===0)this.r=this.g=this.b=n;else{let r=n<=.5?n*(1+e):n+e-n*e,o=2*n-r;this.r=jc(o,r,t+1/3),this.g=jc(o,r,t),this.b=jc(o,r,t-1/3)}return ye.toWorkingColorSpace(this,s),this}setStyle(t,e=Un){function n(r){r!==void 0&&parseFloat(r)<1&&console.warn("THREE.Color: Alpha component of "+t+" will be ignored.")}let s;if(s=/^(\w+)\(([^\)]*)\)/.exec(t)){let r,o=s[1],a=s[2];switch(o){case"rgb":case"rgba":if(r=/^\s*(\d+)\s*,\s*(\d+)\s*,\s*(\d+)\s*(?:,\s*(\d*\.?\d+)\s*)?$/.exec(a))return n(r[4]),this.setRGB(Math.min(255,parseInt(r[1],10))/255,Math.min(255,parseInt(r[2],10))/255,Math.min(255,parseInt(r[3],10))/255,e);if(r=/^\s*(\d+)\%\s*,\s*(\d+)\%\s*,\s*(\d+)\%\s*(?:,\s*(\d*\.?\d+)\s*)?$/.exec(a))return n(r[4]),this.setRGB(Math.min(100,parseInt(r[1],10))/100,Math.min(100,parseInt(r[2],10))/100,Math.min(100,parseInt(r[3],10))/100,e);break;case"hsl":case"hsla":if(r=/^\s*(\d*\.?\d+)\s*,\s*(\d*\.?\d+)\%\s*,\s*(\d*\.?\d+)\%\s*(?:,\s*(\d*\.?\d+)\s*)?$/.exec(a))return n(r[4]),this.setHSL(parseFloat(r[1])/360,parseFloat(r[2])/100,parseFloat(r[3])/100,e);break;default:console.warn("THREE.Color: Unknown color model "+t)}}else if(s=/^\#([A-Fa-f\d]+)$/.exec(t)){let r=s[1],o=r.length;if(o===3)return this.setRGB(parseInt(r.charAt(0),16)/15,parseInt(r.charAt(1),16)/15,parseInt(r.charAt(2),16)/15,e);if(o===6)return this.setHex(parseInt(r,16),e);console.warn("THREE.Color: Invalid hex color "+t)}else if(t&&t.length>0)return this.setColorName(t,e);return this}setColorName(t,e=Un){let n=Pm[t.toLowerCase()];return n!==void 0?this.setHex(n,e):console.warn("THREE.Color: Unknown color "+t),this}clone(){return new this.constructor(this.r,this.g,this.b)}copy(t){return this.r=t.r,this.g=t.g,this.b=t.b,this}copySRGBToLinear(t){return this.r=Ki(t.r),this.g=Ki(t.g),this.b=Ki(t.b),this}copyLinearToSRGB(t){return this.r=qr(t.r),this.g=qr(t.g),this.b=qr(t.b),this}convertSRGBToLinear(){return this.copySRGBToLinear(this),this}convertLinearToSRGB(){return this.copyLinearToSRGB(this),this}getHex(t=Un){return ye.fromWorkingColorSpace(_n.copy(this),t),Math.round(xn(_n.r*255,0,255))*65536+Math.round(xn(_n.g*255,0,255))*256+Math.round(xn(_n.b*255,0,255))}getHexString(t=Un){return("000000"+this.getHex(t).toString(16)).slice(-6)}getHSL(t,e=ye.workingColorSpace){ye.fromWorkingColorSpace(_n.copy(this),e);let n=_n.r,s=_n.g,r=_n.b,o=Math.max(n,s,r),a=Math.min(n,s,r),l,c,u=(a+o)/2;if(a===o)l=0,c=0;else{let f=o-a;switch(c=u<=.5?f/(o+a):f/(2-o-a),o){case n:l=(s-r)/f+(s<r?6:0);break;case s:l=(r-n)/f+2;break;case r:l=(n-s)/f+4;break}l/=6}return t.h=l,t.s=c,t.l=u,t}getRGB(t,e=ye.workingColorSpace){return ye.fromWorkingColorSpace(_n.copy(this),e),t.r=_n.r,t.g=_n.g,t.b=_n.b,t}getStyle(t=Un){ye.fromWorkingColorSpace(_n.copy(this),t);let e=_n.r,n=_n.g,s=_n.b;return t!==Un?`color(${t} ${e.toFixed(3)} ${n.toFixed(3)} ${s.toFixed(3)})`:`rgb(${Math.round(e*255)},${Math.round(n*255)},${Math.round(s*255)})`}offsetHSL(t,e,n){return this.getHSL(gs),this.setHSL(gs.h+t,gs.s+e,gs.l+n)}add(t){return this.r+=t.r,this.g+=t.g,this.b+=t.b,this}addColors(t,e){return this.r=t.r+e.r,this.g=t.g+e.g,this.b=t.b+e.b,this}addScalar(t){return this.r+=t,this.g+=t,this.b+=t,this}sub(t){return this.r=Math.max(0,this.r-t.r),this.g=Math.max(0,this.g-t.g),this.b=Math.max(0,this.b-t.b),this}multiply(t){return this.r*=t.r,this.g*=t.g,this.b*=t.b,this}multiplyScalar(t){return this.r*=t,this.g*=t,this.b*=t,this}lerp(t,e){return this.r+=(t.r-this.r)*e,this.g+=(t.g-this.g)*e,this.b+=(t.b-this.b)*e,this}lerpColors(t,e,n){return this.r=t.r+(e.r-t.r)*n,this.g=t.g+(e.g-t.g)*n,this.b=t.b+(e.b-t.b)*n,this}lerpHSL(t,e){this.getHSL(gs),t.getHSL(La);let n=Oo(gs.h,La.h,e),s=Oo(gs.s,La.s,e),r=Oo(gs.l,La.l,e);return this.setHSL(n,s,r),this}setFromVector3(t){return this.r=t.x,this.g=t.y,this.b=t.z,this}applyMatrix3(t){let e=this.r,n=this.g,s=this.b,r=t.elements;return this.r=r[0]*e+r[3]*n+r[6]*s,this.g=r[1]*e+r[4]*n+r[7]*s,this.b=r[2]*e+r[5]*n+r[8]*s,this}equals(t){return t.r===this.r&&t.g===this.g&&t.b===this.b}fromArray(t,e=0){return this.r=t[e],this.g=t[e+1],this.b=t[e+2],this}toArray(t=[],e=0){return t[e]=this.r,t[e+1]=this.g,t[e+2]=this.b,t}fromBufferAttribute(t,e){return this.r=t.getX(e),this.g=t.getY(e),this.b=t.getZ(e),this}toJSON(){return this.getHex()}*[Symbol.iterator](){yield this.r,yield this.g,yield this.b}},_n=new pe;pe.NAMES=Pm;var Fx=0,Ss=class extends Qi{static get type(){return"Material"}get type(){return this.constructor.type}set type(t){}constructor(){super(),this.isMaterial=!0,Object.defineProperty(this,"id",{value:Fx++}),this.uuid=oo(),this.name="",this.blending=Wr,this.side=Ms,this.vertexColors=!1,this.opacity=1,this.transparent=!1,this.alphaHash=!1,this.blendSrc=hh,this.blendDst=uh,this.blendEquation=qs,this.blendSrcAlpha=null,this.blendDstAlpha=null,this.blendEquationAlpha=null,this.blendColor=new pe(0,0,0),this.blendAlpha=0,this.depthFunc=$r,this.depthTest=!0,this.depthWrite=!0,this.stencilWriteMask=255,this.stencilFunc=dp,this.stencilRef=0,this.stencilFuncMask=255,this.stencilFail=Cr,this.stencilZFail=Cr,this.stencilZPass=Cr,this.stencilWrite=!1,this.clippingPlanes=null,this.clipIntersection=!1,this.clipShadows=!1,this.shadowSide=null,this.colorWrite=!0,this.precision=null,this.polygonOffset=!1,this.polygonOffsetFactor=0,this.polygonOffsetUnits=0,this.dithering=!1,this.alphaToCoverage=!1,this.premultipliedAlpha=!1,this.forceSinglePass=!1,this.visible=!0,this.toneMapped=!0,this.userData={},this.version=0,this._alphaTest=0}get alphaTest(){return this._alphaTest}set alphaTest(t){this._alphaTest>0!=t>0&&this.version++,this._alphaTest=t}onBeforeRender(){}onBeforeCompile(){}customProgramCacheKey(){return this.onBeforeCompile.toString()}setValues(t){if(t!==void 0)for(let e in t){let n=t[e];if(n===void 0){console.warn(`THREE.Material: parameter '${e}' has value of undefined.`);continue}let s=this[e];if(s===void 0){console.warn(`THREE.Material: '${e}' is not a property of THREE.${this.type}.`);continue}s&&s.isColor?s.set(n):s&&s.isVector3&&n&&n.isVector3?s.copy(n):this[e]=n}}toJSON(t){let e=t===void 0||typeof t=="string";e&&(t={textures:{},images:{}});let n={metadata:{version:4.6,type:"Material",generator:"Material.toJSON"}};n.uuid=this.uuid,n.type=this.type,this.name!==""&&(n.name=this.name),this.color&&this.color.isColor&&(n.color=this.color.getHex()),this.roughness!==void 0&&(n.roughness=this.roughness),this.metalness!==void 0&&(n.metalness=this.metalness),this.sheen!==void 0&&(n.sheen=this.sheen),this.sheenColor&&this.sheenColor.isColor&&(n.sheenColor=this.sheenColor.getHex()),this.sheenRoughness!==void 0&&(n.sheenRoughness=this.sheenRoughness),this.emissive&&this.emissive.isColor&&(n.emissive=this.emissive.getHex()),this.emissiveIntensity!==void 0&&this.emissiveIntensity!==1&&(n.emissiveIntensity=this.emissiveIntensity),this.specular&&this.specular.isColor&&(n.specular=this.specular.getHex()),this.specularIntensity!==void 0&&(n.specularIntensity=this.specularIntensity),this.specularColor&&this.specularColor.isColor&&(n.specularColor=this.specularColor.getHex()),this.shininess!==void 0&&(n.shininess=this.shininess),this.clearcoat!==void 0&&(n.clearcoat=this.clearcoat),this.clearcoatRoughness!==void 0&&(n.clearcoatRoughness=this.clearcoatRoughness),this.clearcoatMap&&this.clearcoatMap.isTexture&&(n.clearcoatMap=this.clearcoatMap.toJSON(t).uuid),this.clearcoatRoughnessMap&&this.clearcoatRoughnessMap.isTexture&&(n.clearcoatRoughnessMap=this.clearcoatRoughnessMap.toJSON(t).uuid),this.clearcoatNormalMap&&this.clearcoatNormalMap.isTexture&&(n.clearcoatNormalMap=this.clearcoatNormalMap.toJSON(t).uuid,n.clearcoatNormalScale=this.clearcoatNormalScale.toArray()),this.dispersion!==void 0&&(n.dispersion=this.dispersion),this.iridescence!==void 0&&(n.iridescence=this.iridescence),this.iridescenceIOR!==void 0&&(n.iridescenceIOR=this.iridescenceIOR),this.iridescenceThicknessRange!==void 0&&(n.iridescenceThicknessRange=this.iridescenceThicknessRange),this.iridescenceMap&&this.iridescenceMap.isTexture&&(n.iridescenceMap=this.iridescenceMap.toJSON(t).uuid),this.iridescenceThicknessMap&&this.iridescenceThicknessMap.isTexture&&(n.iridescenceThicknessMap=this.iridescenceThicknessMap.toJSON(t).uuid),this.anisotropy!==void 0&&(n.anisotropy=this.anisotropy),this.anisotropyRotation!==void 0&&(n.anisotropyRotation=this.anisotropyRotation),this.anisotropyMap&&this.anisotropyMap.isTexture&&(n.anisotropyMap=this.anisotropyMap.toJSON(t).uuid),this.map&&this.map.isTexture&&(n.map=this.map.toJSON(t).uuid),this.matcap&&this.matcap.isTexture&&(n.matcap=this.matcap.toJSON(t).uuid),this.alphaMap&&this.alphaMap.isTexture&&(n.alphaMap=this.alphaMap.toJSON(t).uuid),this.lightMap&&this.lightMap.isTexture&&(n.lightMap=this.lightMap.toJSON(t).uuid,n.lightMapIntensity=this.lightMapIntensity),this.aoMap&&this.aoMap.isTexture&&(n.aoMap=this.aoMap.toJSON(t).uuid,n.aoMapIntensity=this.aoMapIntensity),this.bumpMap&&this.bumpMap.isTexture&&(n.bumpMap=this.bumpMap.toJSON(t).uuid,n.bumpScale=this.bumpScale),this.normalMap&&this.normalMap.isTexture&&(n.normalMap=this.normalMap.toJSON(t).uuid,n.normalMapType=this.normalMapType,n.normalScale=this.normalScale.toArray()),this.displacementMap&&this.displacementMap.isTexture&&(n.displacementMap=this.displacementMap.toJSON(t).uuid,n.displacementScale=this.displacementScale,n.displacementBias=this.displacementBias),this.roughnessMap&&this.roughnessMap.isTexture&&(n.roughnessMap=this.roughnessMap.toJSON(t).uuid),this.metalnessMap&&this.metalnessMap.isTexture&&(n.metalnessMap=this.metalnessMap.toJSON(t).uuid),this.emissiveMap&&this.emissiveMap.isTexture&&(n.emissiveMap=this.emissiveMap.toJSON(t).uuid),this.specularMap&&this.specularMap.isTexture&&(n.specularMap=this.specularMap.toJSON(t).uuid),this.specularIntensityMap&&this.specularIntensityMap.isTexture&&(n.specularIntensityMap=this.specularIntensityMap.toJSON(t).uuid),this.specularColorMap&&this.specularColorMap.isTexture&&(n.specularColorMap=this.specularColorMap.toJSON(t).uuid),this.envMap&&this.envMap.isTexture&&(n.envMap=this.envMap.toJSON(t).uuid,this.combine!==void 0&&(n.combine=this.combine)),this.envMapRotation!==void 0&&(n.envMapRotation=this.envMapRotation.toArray()),this.envMapIntensity!==void 0&&(n.envMapIntensity=this.envMapIntensity),this.reflectivity!==void 0&&(n.reflectivity=this.reflectivity),this.refractionRatio!==void 0&&(n.refractionRatio=this.refractionRatio),this.gradientMap&&this.gradientMap.isTexture&&(n.gradientMap=this.gradientMap.toJSON(t).uuid),this.transmission!==void 0&&(n.transmission=this.transmission),this.transmissionMap&&this.transmissionMap.isTexture&&(n.transmissionMap=this.transmissionMap.toJSON(t).uuid),this.thickness!==void 0&&(n.thickness=this.thickness),this.thicknessMap&&this.thicknessMap.isTexture&&(n.thicknessMap=this.thicknessMap.toJSON(t).uuid),this.attenuationDistance!==void 0&&this.attenuationDistance!==1/0&&(n.attenuationDistance=this.attenuationDistance),this.attenuationColor!==void 0&&(n.attenuationColor=this.attenuationColor.getHex()),this.size!==void 0&&(n.size=this.size),this.shadowSide!==null&&(n.shadowSide=this.shadowSide),this.sizeAttenuation!==void 0&&(n.sizeAttenuation=this.sizeAttenuation),this.blending!==Wr&&(n.blending=this.blending),this.side!==Ms&&(n.side=this.side),this.vertexColors===!0&&(n.vertexColors=!0),this.opacity<1&&(n.opacity=this.opacity),this.transparent===!0&&(n.transparent=!0),this.blendSrc!==hh&&(n.blendSrc=this.blendSrc),this.blendDst!==uh&&(n.blendDst=this.blendDst),this.blendEquation!==qs&&(n.blendEquation=this.blendEquation),this.blendSrcAlpha!==null&&(n.blendSrcAlpha=this.blendSrcAlpha),this.blendDstAlpha!==null&&(n.blendDstAlpha=this.blendDstAlpha),this.blendEquationAlpha!==null&&(n.blendEquationAlpha=this.blendEquationAlpha),this.blendColor&&this.blendColor.isColor&&(n.blendColor=this.blendColor.getHex()),this.blendAlpha!==0&&(n.blendAlpha=this.blendAlpha),this.depthFunc!==$r&&(n.depthFunc=this.depthFunc),this.depthTest===!1&&(n.depthTest=this.depthTest),this.depthWrite===!1&&(n.depthWrite=this.depthWrite),this.colorWrite===!1&&(n.colorWrite=this.colorWrite),this.stencilWriteMask!==255&&(n.stencilWriteMask=this.stencilWriteMask),this.stencilFunc!==dp&&(n.stencilFunc=this.stencilFunc),this.stencilRef!==0&&(n.stencilRef=this.stencilRef),this.stencilFuncMask!==255&&(n.stencilFuncMask=this.stencilFuncMask),this.stencilFail!==Cr&&(n.stencilFail=this.stencilFail),this.stencilZFail!==Cr&&(n.stencilZFail=this.stencilZFail),this.stencilZPass!==Cr&&(n.stencilZPass=this.stencilZPass),this.stencilWrite===!0&&(n.stencilWrite=this.stencilWrite),this.rotation!==void 0&&this.rotation!==0&&(n.rotation=this.rotation),this.polygonOffset===!0&&(n.polygonOffset=!0),this.polygonOffsetFactor!==0&&(n.polygonOffsetFactor=this.polygonOffsetFactor),this.polygonOffsetUnits!==0&&(n.polygonOffsetUnits=this.polygonOffsetUnits),this.linewidth!==void 0&&this.linewidth!==1&&(n.linewidth=this.linewidth),this.dashSize!==void 0&&(n.dashSize=this.dashSize),this.gapSize!==void 0&&(n.gapSize=this.gapSize),this.scale!==void 0&&(n.scale=this.scale),this.dithering===!0&&(n.dithering=!0),this.alphaTest>0&&(n.alphaTest=this.alphaTest),this.alphaHash===!0&&(n.alphaHash=!0),this.alphaToCoverage===!0&&(n.alphaToCoverage=!0),this.premultipliedAlpha===!0&&(n.premultipliedAlpha=!0),this.forceSinglePass===!0&&(n.forceSinglePass=!0),this.wireframe===!0&&(n.wireframe=!0),this.wireframeLinewidth>1&&(n.wireframeLinewidth=this.wireframeLinewidth),this.wireframeLinecap!=="round"&&(n.wireframeLinecap=this.wireframeLinecap),this.wireframeLinejoin!=="round"&&(n.wireframeLinejoin=this.wireframeLinejoin),this.flatShading===!0&&(n.flatShading=!0),this.visible===!1&&(n.visible=!1),this.toneMapped===!1&&(n.toneMapped=!1),this.fog===!1&&(n.fog=!1),Object.keys(this.userData).length>0&&(n.userData=this.userData);function s(r){let o=[];for(let a in r){let l=r[a];delete l.metadata,o.push(l)}return o}if(e){let r=s(t.textures),o=s(t.images);r.length>0&&(n.textures=r),o.length>0&&(n.images=o)}return n}clone(){return new this.constructor().copy(this)}copy(t){this.name=t.name,this.blending=t.blending,this.side=t.side,this.vertexColors=t.vertexColors,this.opacity=t.opacity,this.transparent=t.transparent,this.blendSrc=t.blendSrc,this.blendDst=t.blendDst,this.blendEquation=t.blendEquation,this.blendSrcAlpha=t.blendSrcAlpha,this.blendDstAlpha=t.blendDstAlpha,this.blendEquationAlpha=t.blendEquationAlpha,this.blendColor.copy(t.blendColor),this.blendAlpha=t.blendAlpha,this.depthFunc=t.depthFunc,this.depthTest=t.depthTest,this.depthWrite=t.depthWrite,this.stencilWriteMask=t.stencilWriteMask,this.stencilFunc=t.stencilFunc,this.stencilRef=t.stencilRef,this.stencilFuncMask=t.stencilFuncMask,this.stencilFail=t.stencilFail,this.stencilZFail=t.stencilZFail,this.stencilZPass=t.stencilZPass,this.stencilWrite=t.stencilWrite;let e=t.clippingPlanes,n=null;if(e!==null){let s=e.length;n=new Array(s);for(let r=0;r!==s;++r)n[r]=e[r].clone()}return this.clippingPlanes=n,this.clipIntersection=t.clipIntersection,this.clipShadows=t.clipShadows,this.shadowSide=t.shadowSide,this.colorWrite=t.colorWrite,this.precision=t.precision,this.polygonOffset=t.polygonOffset,this.polygonOffsetFactor=t.polygonOffsetFactor,this.polygonOffsetUnits=t.polygonOffsetUnits,this.dithering=t.dithering,this.alphaTest=t.alphaTest,this.alphaHash=t.alphaHash,this.alphaToCoverage=t.alphaToCoverage,this.premultipliedAlpha=t.premultipliedAlpha,this.forceSinglePass=t.forceSinglePass,this.visible=t.visible,this.toneMapped=t.toneMapped,this.userData=JSON.parse(JSON.stringify(t.userData)),this}dispose(){this.dispatchEvent({type:"dispose"})}set needsUpdate(t){t===!0&&this.version++}onBuild(){console.warn("Material: onBuild() has been removed.")}},eo=class extends Ss{static get type(){return"MeshBasicMaterial"}constructor(t){super(),this.isMeshBasicMaterial=!0,this.color=new pe(16777215),this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.specularMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Li,this.combine=pm,this.reflectivity=1,this.refractionRatio=.98,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.lightMap=t.lightMap,this.lightMapIntensity=t.lightMapIntensity,this.aoMap=t.aoMap,this.aoMapIntensity=t.aoMapIntensity,this.specularMap=t.specularMap,this.alphaMap=t.alphaMap,this.envMap=t.envMap,this.envMapRotation.copy(t.envMapRotation),this.combine=t.combine,this.reflectivity=t.reflectivity,this.refractionRatio=t.refractionRatio,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.wireframeLinecap=t.wireframeLinecap,this.wireframeLinejoin=t.wireframeLinejoin,this.fog=t.fog,this}};var Je=new Y,Da=new se,pn=class{constructor(t,e,n=!1){if(Array.isArray(t))throw new TypeError("THREE.BufferAttribute: array should be a Typed Array.");this.isBufferAttribute=!0,this.name="",this.array=t,this.itemSize=e,this.count=t!==void 0?t.length/e:0,this.normalized=n,this.usage=pp,this.updateRanges=[],this.gpuType=$i,this.version=0}onUploadCallback(){}set needsUpdate(t){t===!0&&this.version++}setUsage(t){return this.usage=t,this}addUpdateRange(t,e){this.updateRanges.push({start:t,count:e})}clearUpdateRanges(){this.updateRanges.length=0}copy(t){return this.name=t.name,this.array=new t.array.constructor(t.array),this.itemSize=t.itemSize,this.count=t.count,this.normalized=t.normalized,this.usage=t.usage,this.gpuType=t.gpuType,this}copyAt(t,e,n){t*=this.itemSize,n*=e.itemSize;for(let s=0,r=this.itemSize;s<r;s++)this.array[t+s]=e.array[n+s];return this}copyArray(t){return this.array.set(t),this}applyMatrix3(t){if(this.itemSize===2)for(let e=0,n=this.count;e<n;e++)Da.fromBufferAttribute(this,e),Da.applyMatrix3(t),this.setXY(e,Da.x,Da.y);else if(this.itemSize===3)for(let e=0,n=this.count;e<n;e++)Je.fromBufferAttribute(this,e),Je.applyMatrix3(t),this.setXYZ(e,Je.x,Je.y,Je.z);return this}applyMatrix4(t){for(let e=0,n=this.count;e<n;e++)Je.fromBufferAttribute(this,e),Je.applyMatrix4(t),this.setXYZ(e,Je.x,Je.y,Je.z);return this}applyNormalMatrix(t){for(let e=0,n=this.count;e<n;e++)Je.fromBufferAttribute(this,e),Je.applyNormalMatrix(t),this.setXYZ(e,Je.x,Je.y,Je.z);return this}transformDirection(t){for(let e=0,n=this.count;e<n;e++)Je.fromBufferAttribute(this,e),Je.transformDirection(t),this.setXYZ(e,Je.x,Je.y,Je.z);return this}set(t,e=0){return this.array.set(t,e),this}getComponent(t,e){let n=this.array[t*this.itemSize+e];return this.normalized&&(n=Hr(n,this.array)),n}setComponent(t,e,n){return this.normalized&&(n=En(n,this.array)),this.array[t*this.itemSize+e]=n,this}getX(t){let e=this.array[t*this.itemSize];return this.normalized&&(e=Hr(e,this.array)),e}setX(t,e){return this.normalized&&(e=En(e,this.array)),this.array[t*this.itemSize]=e,this}getY(t){let e=this.array[t*this.itemSize+1];return this.normalized&&(e=Hr(e,this.array)),e}setY(t,e){return this.normalized&&(e=En(e,this.array)),this.array[t*this.itemSize+1]=e,this}getZ(t){let e=this.array[t*this.itemSize+2];return this.normalized&&(e=Hr(e,this.array)),e}setZ(t,e){return this.normalized&&(e=En(e,this.array)),this.array[t*this.itemSize+2]=e,this}getW(t){let e=this.array[t*this.itemSize+3];return this.normalized&&(e=Hr(e,this.array)),e}setW(t,e){return this.normalized&&(e=En(e,this.array)),this.array[t*this.itemSize+3]=e,this}setXY(t,e,n){return t*=this.itemSize,this.normalized&&(e=En(e,this.array),n=En(n,this.array)),this.array[t+0]=e,this.array[t+1]=n,this}setXYZ(t,e,n,s){return t*=this.itemSize,this.normalized&&(e=En(e,this.array),n=En(n,this.array),s=En(s,this.array)),this.array[t+0]=e,this.array[t+1]=n,this.array[t+2]=s,this}setXYZW(t,e,n,s,r){return t*=this.itemSize,this.normalized&&(e=En(e,this.array),n=En(n,this.array),s=En(s,this.array),r=En(r,this.array)),this.array[t+0]=e,this.array[t+1]=n,this.array[t+2]=s,this.array[t+3]=r,this}onUpload(t){return this.onUploadCallback=t,this}clone(){return new this.constructor(this.array,this.itemSize).copy(this)}toJSON(){let t={itemSize:this.itemSize,type:this.array.constructor.name,array:Array.from(this.array),normalized:this.normalized};return this.name!==""&&(t.name=this.name),this.usage!==pp&&(t.usage=this.usage),t}};var rl=class extends pn{constructor(t,e,n){super(new Uint16Array(t),e,n)}};var ol=class extends pn{constructor(t,e,n){super(new Uint32Array(t),e,n)}};var On=class extends pn{constructor(t,e,n){super(new Float32Array(t),e,n)}},Bx=0,ni=new Ge,Qc=new Rn,Br=new Y,$n=new js,Io=new js,un=new Y,Bn=class i extends Qi{constructor(){super(),this.isBufferGeometry=!0,Object.defineProperty(this,"id",{value:Bx++}),this.uuid=oo(),this.name="",this.type="BufferGeometry",this.index=null,this.indirect=null,this.attributes={},this.morphAttributes={},this.morphTargetsRelative=!1,this.groups=[],this.boundingBox=null,this.boundingSphere=null,this.drawRange={start:0,count:1/0},this.userData={}}getIndex(){return this.index}setIndex(t){return Array.isArray(t)?this.index=new(Rm(t)?ol:rl)(t,1):this.index=t,this}setIndirect(t){return this.indirect=t,this}getIndirect(){return this.indirect}getAttribute(t){return this.attributes[t]}setAttribute(t,e){return this.attributes[t]=e,this}deleteAttribute(t){return delete this.attributes[t],this}hasAttribute(t){return this.attributes[t]!==void 0}addGroup(t,e,n=0){this.groups.push({start:t,count:e,materialIndex:n})}clearGroups(){this.groups=[]}setDrawRange(t,e){this.drawRange.start=t,this.drawRange.count=e}applyMatrix4(t){let e=this.attributes.position;e!==void 0&&(e.applyMatrix4(t),e.needsUpdate=!0);let n=this.attributes.normal;if(n!==void 0){let r=new oe().getNormalMatrix(t);n.applyNormalMatrix(r),n.needsUpdate=!0}let s=this.attributes.tangent;return s!==void 0&&(s.transformDirection(t),s.needsUpdate=!0),this.boundingBox!==null&&this.computeBoundingBox(),this.boundingSphere!==null&&this.computeBoundingSphere(),this}applyQuaternion(t){return ni.makeRotationFromQuaternion(t),this.applyMatrix4(ni),this}rotateX(t){return ni.makeRotationX(t),this.applyMatrix4(ni),this}rotateY(t){return ni.makeRotationY(t),this.applyMatrix4(ni),this}rotateZ(t){return ni.makeRotationZ(t),this.applyMatrix4(ni),this}translate(t,e,n){return ni.makeTranslation(t,e,n),this.applyMatrix4(ni),this}scale(t,e,n){return ni.makeScale(t,e,n),this.applyMatrix4(ni),this}lookAt(t){return Qc.lookAt(t),Qc.updateMatrix(),this.applyMatrix4(Qc.matrix),this}center(){return this.computeBoundingBox(),this.boundingBox.getCenter(Br).negate(),this.translate(Br.x,Br.y,Br.z),this}setFromPoints(t){let e=this.getAttribute("position");if(e===void 0){let n=[];for(let s=0,r=t.length;s<r;s++){let o=t[s];n.push(o.x,o.y,o.z||0)}this.setAttribute("position",new On(n,3))}else{for(let n=0,s=e.count;n<s;n++){let r=t[n];e.setXYZ(n,r.x,r.y,r.z||0)}t.length>e.count&&console.warn("THREE.BufferGeometry: Buffer size too small for points data. Use .dispose() and create a new geometry."),e.needsUpdate=!0}return this}computeBoundingBox(){this.boundingBox===null&&(this.boundingBox=new js);let t=this.attributes.position,e=this.morphAttributes.position;if(t&&t.isGLBufferAttribute){console.error("THREE.BufferGeometry.computeBoundingBox(): GLBufferAttribute requires a manual bounding box.",this),this.boundingBox.set(new Y(-1/0,-1/0,-1/0),new Y(1/0,1/0,1/0));return}if(t!==void 0){if(this.boundingBox.setFromBufferAttribute(t),e)for(let n=0,s=e.length;n<s;n++){let r=e[n];$n.setFromBufferAttribute(r),this.morphTargetsRelative?(un.addVectors(this.boundingBox.min,$n.min),this.boundingBox.expandByPoint(un),un.addVectors(this.boundingBox.max,$n.max),this.boundingBox.expandByPoint(un)):(this.boundingBox.expandByPoint($n.min),this.boundingBox.expandByPoint($n.max))}}else this.boundingBox.makeEmpty();(isNaN(this.boundingBox.min.x)||isNaN(this.boundingBox.min.y)||isNaN(this.boundingBox.min.z))&&console.error('THREE.BufferGeometry.computeBoundingBox(): Computed min/max have NaN values. The "position" attribute is likely to have NaN values.',this)}computeBoundingSphere(){this.boundingSphere===null&&(this.boundingSphere=new Qr);let t=this.attributes.position,e=this.morphAttributes.position;if(t&&t.isGLBufferAttribute){console.error("THREE.BufferGeometry.computeBoundingSphere(): GLBufferAttribute requires a manual bounding sphere.",this),this.boundingSphere.set(new Y,1/0);return}if(t){let n=this.boundingSphere.center;if($n.setFromBufferAttribute(t),e)for(let r=0,o=e.length;r<o;r++){let a=e[r];Io.setFromBufferAttribute(a),this.morphTargetsRelative?(un.addVectors($n.min,Io.min),$n.expandByPoint(un),un.addVectors($n.max,Io.max),$n.expandByPoint(un)):($n.expandByPoint(Io.min),$n.expandByPoint(Io.max))}$n.getCenter(n);let s=0;for(let r=0,o=t.count;r<o;r++)un.fromBufferAttribute(t,r),s=Math.max(s,n.distanceToSquared(un));if(e)for(let r=0,o=e.length;r<o;r++){let a=e[r],l=this.morphTargetsRelative;for(let c=0,u=a.count;c<u;c++)un.fromBufferAttribute(a,c),l&&(Br.fromBufferAttribute(t,c),un.add(Br)),s=Math.max(s,n.distanceToSquared(un))}this.boundingSphere.radius=Math.sqrt(s),isNaN(this.boundingSphere.radius)&&console.error('THREE.BufferGeometry.computeBoundingSphere(): Computed radius is NaN. The "position" attribute is likely to have NaN values.',this)}}computeTangents(){let t=this.index,e=this.attributes;if(t===null||e.position===void 0||e.normal===void 0||e.uv===void 0){console.error("THREE.BufferGeometry: .computeTangents() failed. Missing required attributes (index, position, normal or uv)");return}let n=e.position,s=e.normal,r=e.uv;this.hasAttribute("tangent")===!1&&this.setAttribute("tangent",new pn(new Float32Array(4*n.count),4));let o=this.getAttribute("tangent"),a=[],l=[];for(let L=0;L<n.count;L++)a[L]=new Y,l[L]=new Y;let c=new Y,u=new Y,f=new Y,h=new se,p=new se,_=new se,g=new Y,m=new Y;function d(L,E,b){c.fromBufferAttribute(n,L),u.fromBufferAttribute(n,E),f.fromBufferAttribute(n,b),h.fromBufferAttribute(r,L),p.fromBufferAttribute(r,E),_.fromBufferAttribute(r,b),u.sub(c),f.sub(c),p.sub(h),_.sub(h);let A=1/(p.x*_.y-_.x*p.y);isFinite(A)&&(g.copy(u).multiplyScalar(_.y).addScaledVector(f,-p.y).multiplyScalar(A),m.copy(f).multiplyScalar(p.x).addScaledVector(u,-_.x).multiplyScalar(A),a[L].add(g),a[E].add(g),a[b].add(g),l[L].add(m),l[E].add(m),l[b].add(m))}let S=this.groups;S.length===0&&(S=[{start:0,count:t.count}]);for(let L=0,E=S.length;L<E;++L){let b=S[L],A=b.start,O=b.count;for(let F=A,G=A+O;F<G;F+=3)d(t.getX(F+0),t.getX(F+1),t.getX(F+2))}let v=new Y,y=new Y,I=new Y,C=new Y;function R(L){I.fromBufferAttribute(s,L),C.copy(I);let E=a[L];v.copy(E),v.sub(I.multiplyScalar(I.dot(E))).normalize(),y.crossVectors(C,E);let A=y.dot(l[L])<0?-1:1;o.setXYZW(L,v.x,v.y,v.z,A)}for(let L=0,E=S.length;L<E;++L){let b=S[L],A=b.start,O=b.count;for(let F=A,G=A+O;F<G;F+=3)R(t.getX(F+0)),R(t.getX(F+1)),R(t.getX(F+2))}}computeVertexNormals(){let t=this.index,e=this.getAttribute("position");if(e!==void 0){let n=this.getAttribute("normal");if(n===void 0)n=new pn(new Float32Array(e.count*3),3),this.setAttribute("normal",n);else for(let h=0,p=n.count;h<p;h++)n.setXYZ(h,0,0,0);let s=new Y,r=new Y,o=new Y,a=new Y,l=new Y,c=new Y,u=new Y,f=new Y;if(t)for(let h=0,p=t.count;h<p;h+=3){let _=t.getX(h+0),g=t.getX(h+1),m=t.getX(h+2);s.fromBufferAttribute(e,_),r.fromBufferAttribute(e,g),o.fromBufferAttribute(e,m),u.subVectors(o,r),f.subVectors(s,r),u.cross(f),a.fromBufferAttribute(n,_),l.fromBufferAttribute(n,g),c.fromBufferAttribute(n,m),a.add(u),l.add(u),c.add(u),n.setXYZ(_,a.x,a.y,a.z),n.setXYZ(g,l.x,l.y,l.z),n.setXYZ(m,c.x,c.y,c.z)}else for(let h=0,p=e.count;h<p;h+=3)s.fromBufferAttribute(e,h+0),r.fromBufferAttribute(e,h+1),o.fromBufferAttribute(e,h+2),u.subVectors(o,r),f.subVectors(s,r),u.cross(f),n.setXYZ(h+0,u.x,u.y,u.z),n.setXYZ(h+1,u.x,u.y,u.z),n.setXYZ(h+2,u.x,u.y,u.z);this.normalizeNormals(),n.needsUpdate=!0}}normalizeNormals(){let t=this.attributes.normal;for(let e=0,n=t.count;e<n;e++)un.fromBufferAttribute(t,e),un.normalize(),t.setXYZ(e,un.x,un.y,un.z)}toNonIndexed(){function t(a,l){let c=a.array,u=a.itemSize,f=a.normalized,h=new c.constructor(l.length*u),p=0,_=0;for(let g=0,m=l.length;g<m;g++){a.isInterleavedBufferAttribute?p=l[g]*a.data.stride+a.offset:p=l[g]*u;for(let d=0;d<u;d++)h[_++]=c[p++]}return new pn(h,u,f)}if(this.index===null)return console.warn("THREE.BufferGeometry.toNonIndexed(): BufferGeometry is already non-indexed."),this;let e=new i,n=this.index.array,s=this.attributes;for(let a in s){let l=s[a],c=t(l,n);e.setAttribute(a,c)}let r=this.morphAttributes;for(let a in r){let l=[],c=r[a];for(let u=0,f=c.length;u<f;u++){let h=c[u],p=t(h,n);l.push(p)}e.morphAttributes[a]=l}e.morphTargetsRelative=this.morphTargetsRelative;let o=this.groups;for(let a=0,l=o.length;a<l;a++){let c=o[a];e.addGroup(c.start,c.count,c.materialIndex)}return e}toJSON(){let t={metadata:{version:4.6,type:"BufferGeometry",generator:"BufferGeometry.toJSON"}};if(t.uuid=this.uuid,t.type=this.type,this.name!==""&&(t.name=this.name),Object.keys(this.userData).length>0&&(t.userData=this.userData),this.parameters!==void 0){let l=this.parameters;for(let c in l)l[c]!==void 0&&(t[c]=l[c]);return t}t.data={attributes:{}};let e=this.index;e!==null&&(t.data.index={type:e.array.constructor.name,array:Array.prototype.slice.call(e.array)});let n=this.attributes;for(let l in n){let c=n[l];t.data.attributes[l]=c.toJSON(t.data)}let s={},r=!1;for(let l in this.morphAttributes){let c=this.morphAttributes[l],u=[];for(let f=0,h=c.length;f<h;f++){let p=c[f];u.push(p.toJSON(t.data))}u.length>0&&(s[l]=u,r=!0)}r&&(t.data.morphAttributes=s,t.data.morphTargetsRelative=this.morphTargetsRelative);let o=this.groups;o.length>0&&(t.data.groups=JSON.parse(JSON.stringify(o)));let a=this.boundingSphere;return a!==null&&(t.data.boundingSphere={center:a.center.toArray(),radius:a.radius}),t}clone(){return new this.constructor().copy(this)}copy(t){this.index=null,this.attributes={},this.morphAttributes={},this.groups=[],this.boundingBox=null,this.boundingSphere=null;let e={};this.name=t.name;let n=t.index;n!==null&&this.setIndex(n.clone(e));let s=t.attributes;for(let c in s){let u=s[c];this.setAttribute(c,u.clone(e))}let r=t.morphAttributes;for(let c in r){let u=[],f=r[c];for(let h=0,p=f.length;h<p;h++)u.push(f[h].clone(e));this.morphAttributes[c]=u}this.morphTargetsRelative=t.morphTargetsRelative;let o=t.groups;for(let c=0,u=o.length;c<u;c++){let f=o[c];this.addGroup(f.start,f.count,f.materialIndex)}let a=t.boundingBox;a!==null&&(this.boundingBox=a.clone());let l=t.boundingSphere;return l!==null&&(this.boundingSphere=l.clone()),this.drawRange.start=t.drawRange.start,this.drawRange.count=t.drawRange.count,this.userData=t.userData,this}dispose(){this.dispatchEvent({type:"dispose"})}},Lp=new Ge,Vs=new to,Ua=new Qr,Dp=new Y,Na=new Y,Oa=new Y,Fa=new Y,th=new Y,Ba=new Y,Up=new Y,ka=new Y,Cn=class extends Rn{constructor(t=new Bn,e=new eo){super(),this.isMesh=!0,this.type="Mesh",this.geometry=t,this.material=e,this.updateMorphTargets()}copy(t,e){return super.copy(t,e),t.morphTargetInfluences!==void 0&&(this.morphTargetInfluences=t.morphTargetInfluences.slice()),t.morphTargetDictionary!==void 0&&(this.morphTargetDictionary=Object.assign({},t.morphTargetDictionary)),this.material=Array.isArray(t.material)?t.material.slice():t.material,this.geometry=t.geometry,this}updateMorphTargets(){let e=this.geometry.morphAttributes,n=Object.keys(e);if(n.length>0){let s=e[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}getVertexPosition(t,e){let n=this.geometry,s=n.attributes.position,r=n.morphAttributes.position,o=n.morphTargetsRelative;e.fromBufferAttribute(s,t);let a=this.morphTargetInfluences;if(r&&a){Ba.set(0,0,0);for(let l=0,c=r.length;l<c;l++){let u=a[l],f=r[l];u!==0&&(th.fromBufferAttribute(f,t),o?Ba.addScaledVector(th,u):Ba.addScaledVector(th.sub(e),u))}e.add(Ba)}return e}raycast(t,e){let n=this.geometry,s=this.material,r=this.matrixWorld;s!==void 0&&(n.boundingSphere===null&&n.computeBoundingSphere(),Ua.copy(n.boundingSphere),Ua.applyMatrix4(r),Vs.copy(t.ray).recast(t.near),!(Ua.containsPoint(Vs.origin)===!1&&(Vs.intersectSphere(Ua,Dp)===null||Vs.origin.distanceToSquared(Dp)>(t.far-t.near)**2))&&(Lp.copy(r).invert(),Vs.copy(t.ray).applyMatrix4(Lp),!(n.boundingBox!==null&&Vs.intersectsBox(n.boundingBox)===!1)&&this._computeIntersections(t,e,Vs)))}_computeIntersections(t,e,n){let s,r=this.geometry,o=this.material,a=r.index,l=r.attributes.position,c=r.attributes.uv,u=r.attributes.uv1,f=r.attributes.normal,h=r.groups,p=r.drawRange;if(a!==null)if(Array.isArray(o))for(let _=0,g=h.length;_<g;_++){let m=h[_],d=o[m.materialIndex],S=Math.max(m.start,p.start),v=Math.min(a.count,Math.min(m.start+m.count,p.start+p.count));for(let y=S,I=v;y<I;y+=3){let C=a.getX(y),R=a.getX(y+1),L=a.getX(y+2);s=za(this,d,t,n,c,u,f,C,R,L),s&&(s.faceIndex=Math.floor(y/3),s.face.materialIndex=m.materialIndex,e.push(s))}}else{let _=Math.max(0,p.start),g=Math.min(a.count,p.start+p.count);for(let m=_,d=g;m<d;m+=3){let S=a.getX(m),v=a.getX(m+1),y=a.getX(m+2);s=za(this,o,t,n,c,u,f,S,v,y),s&&(s.faceIndex=Math.floor(m/3),e.push(s))}}else if(l!==void 0)if(Array.isArray(o))for(let _=0,g=h.length;_<g;_++){let m=h[_],d=o[m.materialIndex],S=Math.max(m.start,p.start),v=Math.min(l.count,Math.min(m.start+m.count,p.start+p.count));for(let y=S,I=v;y<I;y+=3){let C=y,R=y+1,L=y+2;s=za(this,d,t,n,c,u,f,C,R,L),s&&(s.faceIndex=Math.floor(y/3),s.face.materialIndex=m.materialIndex,e.push(s))}}else{let _=Math.max(0,p.start),g=Math.min(l.count,p.start+p.count);for(let m=_,d=g;m<d;m+=3){let S=m,v=m+1,y=m+2;s=za(this,o,t,n,c,u,f,S,v,y),s&&(s.faceIndex=Math.floor(m/3),e.push(s))}}}};function kx(i,t,e,n,s,r,o,a){let l;if(t.side===Nn?l=n.intersectTriangle(o,r,s,!0,a):l=n.intersectTriangle(s,r,o,t.side===Ms,a),l===null)return null;ka.copy(a),ka.applyMatrix4(i.matrixWorld);let c=e.ray.origin.distanceTo(ka);return c<e.near||c>e.far?null:{distance:c,point:ka.clone(),object:i}}function za(i,t,e,n,s,r,o,a,l,c){i.getVertexPosition(a,Na),i.getVertexPosition(l,Oa),i.getVertexPosition(c,Fa);let u=kx(i,t,e,n,Na,Oa,Fa,Up);if(u){let f=new Y;Ys.getBarycoord(Up,Na,Oa,Fa,f),s&&(u.uv=Ys.getInterpolatedAttribute(s,a,l,c,f,new se)),r&&(u.uv1=Ys.getInterpolatedAttribute(r,a,l,c,f,new se)),o&&(u.normal=Ys.getInterpolatedAttribute(o,a,l,c,f,new Y),u.normal.dot(n.direction)>0&&u.normal.multiplyScalar(-1));let h={a,b:l,c,normal:new Y,materialIndex:0};Ys.getNormal(Na,Oa,Fa,h.normal),u.face=h,u.barycoord=f}return u}var zo=class i extends Bn{constructor(t=1,e=1,n=1,s=1,r=1,o=1){super(),this.type="BoxGeometry",this.parameters={width:t,height:e,depth:n,widthSegments:s,heightSegments:r,depthSegments:o};let a=this;s=Math.floor(s),r=Math.floor(r),o=Math.floor(o);let l=[],c=[],u=[],f=[],h=0,p=0;_("z","y","x",-1,-1,n,e,t,o,r,0),_("z","y","x",1,-1,n,e,-t,o,r,1),_("x","z","y",1,1,t,n,e,s,o,2),_("x","z","y",1,-1,t,n,-e,s,o,3),_("x","y","z",1,-1,t,e,n,s,r,4),_("x","y","z",-1,-1,t,e,-n,s,r,5),this.setIndex(l),this.setAttribute("position",new On(c,3)),this.setAttribute("normal",new On(u,3)),this.setAttribute("uv",new On(f,2));function _(g,m,d,S,v,y,I,C,R,L,E){let b=y/R,A=I/L,O=y/2,F=I/2,G=C/2,$=R+1,W=L+1,Z=0,J=0,ct=new Y;for(let lt=0;lt<W;lt++){let _t=lt*A-F;for(let dt=0;dt<$;dt++){let Yt=dt*b-O;ct[g]=Yt*S,ct[m]=_t*v,ct[d]=G,c.push(ct.x,ct.y,ct.z),ct[g]=0,ct[m]=0,ct[d]=C>0?1:-1,u.push(ct.x,ct.y,ct.z),f.push(dt/R),f.push(1-lt/L),Z+=1}}for(let lt=0;lt<L;lt++)for(let _t=0;_t<R;_t++){let dt=h+_t+$*lt,Yt=h+_t+$*(lt+1),Q=h+(_t+1)+$*(lt+1),ht=h+(_t+1)+$*lt;l.push(dt,Yt,ht),l.push(Yt,Q,ht),J+=6}a.addGroup(p,J,E),p+=J,h+=Z}}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.width,t.height,t.depth,t.widthSegments,t.heightSegments,t.depthSegments)}};function no(i){let t={};for(let e in i){t[e]={};for(let n in i[e]){let s=i[e][n];s&&(s.isColor||s.isMatrix3||s.isMatrix4||s.isVector2||s.isVector3||s.isVector4||s.isTexture||s.isQuaternion)?s.isRenderTargetTexture?(console.warn("UniformsUtils: Textures of render targets cannot be cloned via cloneUniforms() or mergeUniforms()."),t[e][n]=null):t[e][n]=s.clone():Array.isArray(s)?t[e][n]=s.slice():t[e][n]=s}}return t}function Tn(i){let t={};for(let e=0;e<i.length;e++){let n=no(i[e]);for(let s in n)t[s]=n[s]}return t}function zx(i){let t=[];for(let e=0;e<i.length;e++)t.push(i[e].clone());return t}function Im(i){let t=i.getRenderTarget();return t===null?i.outputColorSpace:t.isXRRenderTarget===!0?t.texture.colorSpace:ye.workingColorSpace}var Vx={clone:no,merge:Tn},Hx=`void main() {
	gl_Position = projectionMatrix * modelViewMatrix * vec4( position, 1.0 );
}`,Gx=`void main() {
	gl_FragColor = vec4( 1.0, 0.0, 0.0, 1.0 );
}`,Di=class extends Ss{static get type(){return"ShaderMaterial"}constructor(t){super(),this.isShaderMaterial=!0,this.defines={},this.uniforms={},this.uniformsGroups=[],this.vertexShader=Hx,this.fragmentShader=Gx,this.linewidth=1,this.wireframe=!1,this.wireframeLinewidth=1,this.fog=!1,this.lights=!1,this.clipping=!1,this.forceSinglePass=!0,this.extensions={clipCullDistance:!1,multiDraw:!1},this.defaultAttributeValues={color:[1,1,1],uv:[0,0],uv1:[0,0]},this.index0AttributeName=void 0,this.uniformsNeedUpdate=!1,this.glslVersion=null,t!==void 0&&this.setValues(t)}copy(t){return super.copy(t),this.fragmentShader=t.fragmentShader,this.vertexShader=t.vertexShader,this.uniforms=no(t.uniforms),this.uniformsGroups=zx(t.uniformsGroups),this.defines=Object.assign({},t.defines),this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.fog=t.fog,this.lights=t.lights,this.clipping=t.clipping,this.extensions=Object.assign({},t.extensions),this.glslVersion=t.glslVersion,this}toJSON(t){let e=super.toJSON(t);e.glslVersion=this.glslVersion,e.uniforms={};for(let s in this.uniforms){let o=this.uniforms[s].value;o&&o.isTexture?e.uniforms[s]={type:"t",value:o.toJSON(t).uuid}:o&&o.isColor?e.uniforms[s]={type:"c",value:o.getHex()}:o&&o.isVector2?e.uniforms[s]={type:"v2",value:o.toArray()}:o&&o.isVector3?e.uniforms[s]={type:"v3",value:o.toArray()}:o&&o.isVector4?e.uniforms[s]={type:"v4",value:o.toArray()}:o&&o.isMatrix3?e.uniforms[s]={type:"m3",value:o.toArray()}:o&&o.isMatrix4?e.uniforms[s]={type:"m4",value:o.toArray()}:e.uniforms[s]={value:o}}Object.keys(this.defines).length>0&&(e.defines=this.defines),e.vertexShader=this.vertexShader,e.fragmentShader=this.fragmentShader,e.lights=this.lights,e.clipping=this.clipping;let n={};for(let s in this.extensions)this.extensions[s]===!0&&(n[s]=!0);return Object.keys(n).length>0&&(e.extensions=n),e}},al=class extends Rn{constructor(){super(),this.isCamera=!0,this.type="Camera",this.matrixWorldInverse=new Ge,this.projectionMatrix=new Ge,this.projectionMatrixInverse=new Ge,this.coordinateSystem=Zi}copy(t,e){return super.copy(t,e),this.matrixWorldInverse.copy(t.matrixWorldInverse),this.projectionMatrix.copy(t.projectionMatrix),this.projectionMatrixInverse.copy(t.projectionMatrixInverse),this.coordinateSystem=t.coordinateSystem,this}getWorldDirection(t){return super.getWorldDirection(t).negate()}updateMatrixWorld(t){super.updateMatrixWorld(t),this.matrixWorldInverse.copy(this.matrixWorld).invert()}updateWorldMatrix(t,e){super.updateWorldMatrix(t,e),this.matrixWorldInverse.copy(this.matrixWorld).invert()}clone(){return new this.constructor().copy(this)}},_s=new Y,Np=new se,Op=new se,An=class extends al{constructor(t=50,e=1,n=.1,s=2e3){super(),this.isPerspectiveCamera=!0,this.type="PerspectiveCamera",this.fov=t,this.zoom=1,this.near=n,this.far=s,this.focus=10,this.aspect=e,this.view=null,this.filmGauge=35,this.filmOffset=0,this.updateProjectionMatrix()}copy(t,e){return super.copy(t,e),this.fov=t.fov,this.zoom=t.zoom,this.near=t.near,this.far=t.far,this.focus=t.focus,this.aspect=t.aspect,this.view=t.view===null?null:Object.assign({},t.view),this.filmGauge=t.filmGauge,this.filmOffset=t.filmOffset,this}setFocalLength(t){let e=.5*this.getFilmHeight()/t;this.fov=ko*2*Math.atan(e),this.updateProjectionMatrix()}getFocalLength(){let t=Math.tan(No*.5*this.fov);return .5*this.getFilmHeight()/t}getEffectiveFOV(){return ko*2*Math.atan(Math.tan(No*.5*this.fov)/this.zoom)}getFilmWidth(){return this.filmGauge*Math.min(this.aspect,1)}getFilmHeight(){return this.filmGauge/Math.max(this.aspect,1)}getViewBounds(t,e,n){_s.set(-1,-1,.5).applyMatrix4(this.projectionMatrixInverse),e.set(_s.x,_s.y).multiplyScalar(-t/_s.z),_s.set(1,1,.5).applyMatrix4(this.projectionMatrixInverse),n.set(_s.x,_s.y).multiplyScalar(-t/_s.z)}getViewSize(t,e){return this.getViewBounds(t,Np,Op),e.subVectors(Op,Np)}setViewOffset(t,e,n,s,r,o){this.aspect=t/e,this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=t,this.view.fullHeight=e,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let t=this.near,e=t*Math.tan(No*.5*this.fov)/this.zoom,n=2*e,s=this.aspect*n,r=-.5*s,o=this.view;if(this.view!==null&&this.view.enabled){let l=o.fullWidth,c=o.fullHeight;r+=o.offsetX*s/l,e-=o.offsetY*n/c,s*=o.width/l,n*=o.height/c}let a=this.filmOffset;a!==0&&(r+=t*a/this.getFilmWidth()),this.projectionMatrix.makePerspective(r,r+s,e,e-n,t,this.far,this.coordinateSystem),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(t){let e=super.toJSON(t);return e.object.fov=this.fov,e.object.zoom=this.zoom,e.object.near=this.near,e.object.far=this.far,e.object.focus=this.focus,e.object.aspect=this.aspect,this.view!==null&&(e.object.view=Object.assign({},this.view)),e.object.filmGauge=this.filmGauge,e.object.filmOffset=this.filmOffset,e}},kr=-90,zr=1,Qh=class extends Rn{constructor(t,e,n){super(),this.type="CubeCamera",this.renderTarget=n,this.coordinateSystem=null,this.activeMipmapLevel=0;let s=new An(kr,zr,t,e);s.layers=this.layers,this.add(s);let r=new An(kr,zr,t,e);r.layers=this.layers,this.add(r);let o=new An(kr,zr,t,e);o.layers=this.layers,this.add(o);let a=new An(kr,zr,t,e);a.layers=this.layers,this.add(a);let l=new An(kr,zr,t,e);l.layers=this.layers,this.add(l);let c=new An(kr,zr,t,e);c.layers=this.layers,this.add(c)}updateCoordinateSystem(){let t=this.coordinateSystem,e=this.children.concat(),[n,s,r,o,a,l]=e;for(let c of e)this.remove(c);if(t===Zi)n.up.set(0,1,0),n.lookAt(1,0,0),s.up.set(0,1,0),s.lookAt(-1,0,0),r.up.set(0,0,-1),r.lookAt(0,1,0),o.up.set(0,0,1),o.lookAt(0,-1,0),a.up.set(0,1,0),a.lookAt(0,0,1),l.up.set(0,1,0),l.lookAt(0,0,-1);else if(t===tl)n.up.set(0,-1,0),n.lookAt(-1,0,0),s.up.set(0,-1,0),s.lookAt(1,0,0),r.up.set(0,0,1),r.lookAt(0,1,0),o.up.set(0,0,-1),o.lookAt(0,-1,0),a.up.set(0,-1,0),a.lookAt(0,0,1),l.up.set(0,-1,0),l.lookAt(0,0,-1);else throw new Error("THREE.CubeCamera.updateCoordinateSystem(): Invalid coordinate system: "+t);for(let c of e)this.add(c),c.updateMatrixWorld()}update(t,e){this.parent===null&&this.updateMatrixWorld();let{renderTarget:n,activeMipmapLevel:s}=this;this.coordinateSystem!==t.coordinateSystem&&(this.coordinateSystem=t.coordinateSystem,this.updateCoordinateSystem());let[r,o,a,l,c,u]=this.children,f=t.getRenderTarget(),h=t.getActiveCubeFace(),p=t.getActiveMipmapLevel(),_=t.xr.enabled;t.xr.enabled=!1;let g=n.texture.generateMipmaps;n.texture.generateMipmaps=!1,t.setRenderTarget(n,0,s),t.render(e,r),t.setRenderTarget(n,1,s),t.render(e,o),t.setRenderTarget(n,2,s),t.render(e,a),t.setRenderTarget(n,3,s),t.render(e,l),t.setRenderTarget(n,4,s),t.render(e,c),n.texture.generateMipmaps=g,t.setRenderTarget(n,5,s),t.render(e,u),t.setRenderTarget(f,h,p),t.xr.enabled=_,n.texture.needsPMREMUpdate=!0}},ll=class extends Fn{constructor(t,e,n,s,r,o,a,l,c,u){t=t!==void 0?t:[],e=e!==void 0?e:Zr,super(t,e,n,s,r,o,a,l,c,u),this.isCubeTexture=!0,this.flipY=!1}get images(){return this.image}set images(t){this.image=t}},tu=class extends ts{constructor(t=1,e={}){super(t,t,e),this.isWebGLCubeRenderTarget=!0;let n={width:t,height:t,depth:1},s=[n,n,n,n,n,n];this.texture=new ll(s,e.mapping,e.wrapS,e.wrapT,e.magFilter,e.minFilter,e.format,e.type,e.anisotropy,e.colorSpace),this.texture.isRenderTargetTexture=!0,this.texture.generateMipmaps=e.generateMipmaps!==void 0?e.generateMipmaps:!1,this.texture.minFilter=e.minFilter!==void 0?e.minFilter:Ii}fromEquirectangularTexture(t,e){this.texture.type=e.type,this.texture.colorSpace=e.colorSpace,this.texture.generateMipmaps=e.generateMipmaps,this.texture.minFilter=e.minFilter,this.texture.magFilter=e.magFilter;let n={uniforms:{tEquirect:{value:null}},vertexShader:`

				varying vec3 vWorldDirection;

				vec3 transformDirection( in vec3 dir, in mat4 matrix ) {

					return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );

				}

				void main() {

					vWorldDirection = transformDirection( position, modelMatrix );

					#include <begin_vertex>
					#include <project_vertex>

				}
			`,fragmentShader:`

				uniform sampler2D tEquirect;

				varying vec3 vWorldDirection;

				#include <common>

				void main() {

					vec3 direction = normalize( vWorldDirection );

					vec2 sampleUV = equirectUv( direction );

					gl_FragColor = texture2D( tEquirect, sampleUV );

				}
			`},s=new zo(5,5,5),r=new Di({name:"CubemapFromEquirect",uniforms:no(n.uniforms),vertexShader:n.vertexShader,fragmentShader:n.fragmentShader,side:Nn,blending:ys});r.uniforms.tEquirect.value=e;let o=new Cn(s,r),a=e.minFilter;return e.minFilter===Js&&(e.minFilter=Ii),new Qh(1,10,this).update(t,o),e.minFilter=a,o.geometry.dispose(),o.material.dispose(),this}clear(t,e,n,s){let r=t.getRenderTarget();for(let o=0;o<6;o++)t.setRenderTarget(this,o),t.clear(e,n,s);t.setRenderTarget(r)}},eh=new Y,Wx=new Y,Xx=new oe,gi=class{constructor(t=new Y(1,0,0),e=0){this.isPlane=!0,this.normal=t,this.constant=e}set(t,e){return this.normal.copy(t),this.constant=e,this}setComponents(t,e,n,s){return this.normal.set(t,e,n),this.constant=s,this}setFromNormalAndCoplanarPoint(t,e){return this.normal.copy(t),this.constant=-e.dot(this.normal),this}setFromCoplanarPoints(t,e,n){let s=eh.subVectors(n,e).cross(Wx.subVectors(t,e)).normalize();return this.setFromNormalAndCoplanarPoint(s,t),this}copy(t){return this.normal.copy(t.normal),this.constant=t.constant,this}normalize(){let t=1/this.normal.length();return this.normal.multiplyScalar(t),this.constant*=t,this}negate(){return this.constant*=-1,this.normal.negate(),this}distanceToPoint(t){return this.normal.dot(t)+this.constant}distanceToSphere(t){return this.distanceToPoint(t.center)-t.radius}projectPoint(t,e){return e.copy(t).addScaledVector(this.normal,-this.distanceToPoint(t))}intersectLine(t,e){let n=t.delta(eh),s=this.normal.dot(n);if(s===0)return this.distanceToPoint(t.start)===0?e.copy(t.start):null;let r=-(t.start.dot(this.normal)+this.constant)/s;return r<0||r>1?null:e.copy(t.start).addScaledVector(n,r)}intersectsLine(t){let e=this.distanceToPoint(t.start),n=this.distanceToPoint(t.end);return e<0&&n>0||n<0&&e>0}intersectsBox(t){return t.intersectsPlane(this)}intersectsSphere(t){return t.intersectsPlane(this)}coplanarPoint(t){return t.copy(this.normal).multiplyScalar(-this.constant)}applyMatrix4(t,e){let n=e||Xx.getNormalMatrix(t),s=this.coplanarPoint(eh).applyMatrix4(t),r=this.normal.applyMatrix3(n).normalize();return this.constant=-s.dot(r),this}translate(t){return this.constant-=t.dot(this.normal),this}equals(t){return t.normal.equals(this.normal)&&t.constant===this.constant}clone(){return new this.constructor().copy(this)}},Hs=new Qr,Va=new Y,Vo=class{constructor(t=new gi,e=new gi,n=new gi,s=new gi,r=new gi,o=new gi){this.planes=[t,e,n,s,r,o]}set(t,e,n,s,r,o){let a=this.planes;return a[0].copy(t),a[1].copy(e),a[2].copy(n),a[3].copy(s),a[4].copy(r),a[5].copy(o),this}copy(t){let e=this.planes;for(let n=0;n<6;n++)e[n].copy(t.planes[n]);return this}setFromProjectionMatrix(t,e=Zi){let n=this.planes,s=t.elements,r=s[0],o=s[1],a=s[2],l=s[3],c=s[4],u=s[5],f=s[6],h=s[7],p=s[8],_=s[9],g=s[10],m=s[11],d=s[12],S=s[13],v=s[14],y=s[15];if(n[0].setComponents(l-r,h-c,m-p,y-d).normalize(),n[1].setComponents(l+r,h+c,m+p,y+d).normalize(),n[2].setComponents(l+o,h+u,m+_,y+S).normalize(),n[3].setComponents(l-o,h-u,m-_,y-S).normalize(),n[4].setComponents(l-a,h-f,m-g,y-v).normalize(),e===Zi)n[5].setComponents(l+a,h+f,m+g,y+v).normalize();else if(e===tl)n[5].setComponents(a,f,g,v).normalize();else throw new Error("THREE.Frustum.setFromProjectionMatrix(): Invalid coordinate system: "+e);return this}intersectsObject(t){if(t.boundingSphere!==void 0)t.boundingSphere===null&&t.computeBoundingSphere(),Hs.copy(t.boundingSphere).applyMatrix4(t.matrixWorld);else{let e=t.geometry;e.boundingSphere===null&&e.computeBoundingSphere(),Hs.copy(e.boundingSphere).applyMatrix4(t.matrixWorld)}return this.intersectsSphere(Hs)}intersectsSprite(t){return Hs.center.set(0,0,0),Hs.radius=.7071067811865476,Hs.applyMatrix4(t.matrixWorld),this.intersectsSphere(Hs)}intersectsSphere(t){let e=this.planes,n=t.center,s=-t.radius;for(let r=0;r<6;r++)if(e[r].distanceToPoint(n)<s)return!1;return!0}intersectsBox(t){let e=this.planes;for(let n=0;n<6;n++){let s=e[n];if(Va.x=s.normal.x>0?t.max.x:t.min.x,Va.y=s.normal.y>0?t.max.y:t.min.y,Va.z=s.normal.z>0?t.max.z:t.min.z,s.distanceToPoint(Va)<0)return!1}return!0}containsPoint(t){let e=this.planes;for(let n=0;n<6;n++)if(e[n].distanceToPoint(t)<0)return!1;return!0}clone(){return new this.constructor().copy(this)}};function Lm(){let i=null,t=!1,e=null,n=null;function s(r,o){e(r,o),n=i.requestAnimationFrame(s)}return{start:function(){t!==!0&&e!==null&&(n=i.requestAnimationFrame(s),t=!0)},stop:function(){i.cancelAnimationFrame(n),t=!1},setAnimationLoop:function(r){e=r},setContext:function(r){i=r}}}function qx(i){let t=new WeakMap;function e(a,l){let c=a.array,u=a.usage,f=c.byteLength,h=i.createBuffer();i.bindBuffer(l,h),i.bufferData(l,c,u),a.onUploadCallback();let p;if(c instanceof Float32Array)p=i.FLOAT;else if(c instanceof Uint16Array)a.isFloat16BufferAttribute?p=i.HALF_FLOAT:p=i.UNSIGNED_SHORT;else if(c instanceof Int16Array)p=i.SHORT;else if(c instanceof Uint32Array)p=i.UNSIGNED_INT;else if(c instanceof Int32Array)p=i.INT;else if(c instanceof Int8Array)p=i.BYTE;else if(c instanceof Uint8Array)p=i.UNSIGNED_BYTE;else if(c instanceof Uint8ClampedArray)p=i.UNSIGNED_BYTE;else throw new Error("THREE.WebGLAttributes: Unsupported buffer data format: "+c);return{buffer:h,type:p,bytesPerElement:c.BYTES_PER_ELEMENT,version:a.version,size:f}}function n(a,l,c){let u=l.array,f=l.updateRanges;if(i.bindBuffer(c,a),f.length===0)i.bufferSubData(c,0,u);else{f.sort((p,_)=>p.start-_.start);let h=0;for(let p=1;p<f.length;p++){let _=f[h],g=f[p];g.start<=_.start+_.count+1?_.count=Math.max(_.count,g.start+g.count-_.start):(++h,f[h]=g)}f.length=h+1;for(let p=0,_=f.length;p<_;p++){let g=f[p];i.bufferSubData(c,g.start*u.BYTES_PER_ELEMENT,u,g.start,g.count)}l.clearUpdateRanges()}l.onUploadCallback()}function s(a){return a.isInterleavedBufferAttribute&&(a=a.data),t.get(a)}function r(a){a.isInterleavedBufferAttribute&&(a=a.data);let l=t.get(a);l&&(i.deleteBuffer(l.buffer),t.delete(a))}function o(a,l){if(a.isInterleavedBufferAttribute&&(a=a.data),a.isGLBufferAttribute){let u=t.get(a);(!u||u.version<a.version)&&t.set(a,{buffer:a.buffer,type:a.type,bytesPerElement:a.elementSize,version:a.version});return}let c=t.get(a);if(c===void 0)t.set(a,e(a,l));else if(c.version<a.version){if(c.size!==a.array.byteLength)throw new Error("THREE.WebGLAttributes: The size of the buffer attribute's array buffer does not match the original size. Resizing buffer attributes is not supported.");n(c.buffer,a,l),c.version=a.version}}return{get:s,remove:r,update:o}}var cl=class i extends Bn{constructor(t=1,e=1,n=1,s=1){super(),this.type="PlaneGeometry",this.parameters={width:t,height:e,widthSegments:n,heightSegments:s};let r=t/2,o=e/2,a=Math.floor(n),l=Math.floor(s),c=a+1,u=l+1,f=t/a,h=e/l,p=[],_=[],g=[],m=[];for(let d=0;d<u;d++){let S=d*h-o;for(let v=0;v<c;v++){let y=v*f-r;_.push(y,-S,0),g.push(0,0,1),m.push(v/a),m.push(1-d/l)}}for(let d=0;d<l;d++)for(let S=0;S<a;S++){let v=S+c*d,y=S+c*(d+1),I=S+1+c*(d+1),C=S+1+c*d;p.push(v,y,C),p.push(y,I,C)}this.setIndex(p),this.setAttribute("position",new On(_,3)),this.setAttribute("normal",new On(g,3)),this.setAttribute("uv",new On(m,2))}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.width,t.height,t.widthSegments,t.heightSegments)}},Yx=`#ifdef USE_ALPHAHASH
	if ( diffuseColor.a < getAlphaHashThreshold( vPosition ) ) discard;
#endif`,$x=`#ifdef USE_ALPHAHASH
	const float ALPHA_HASH_SCALE = 0.05;
	float hash2D( vec2 value ) {
		return fract( 1.0e4 * sin( 17.0 * value.x + 0.1 * value.y ) * ( 0.1 + abs( sin( 13.0 * value.y + value.x ) ) ) );
	}
	float hash3D( vec3 value ) {
		return hash2D( vec2( hash2D( value.xy ), value.z ) );
	}
	float getAlphaHashThreshold( vec3 position ) {
		float maxDeriv = max(
			length( dFdx( position.xyz ) ),
			length( dFdy( position.xyz ) )
		);
		float pixScale = 1.0 / ( ALPHA_HASH_SCALE * maxDeriv );
		vec2 pixScales = vec2(
			exp2( floor( log2( pixScale ) ) ),
			exp2( ceil( log2( pixScale ) ) )
		);
		vec2 alpha = vec2(
			hash3D( floor( pixScales.x * position.xyz ) ),
			hash3D( floor( pixScales.y * position.xyz ) )
		);
		float lerpFactor = fract( log2( pixScale ) );
		float x = ( 1.0 - lerpFactor ) * alpha.x + lerpFactor * alpha.y;
		float a = min( lerpFactor, 1.0 - lerpFactor );
		vec3 cases = vec3(
			x * x / ( 2.0 * a * ( 1.0 - a ) ),
			( x - 0.5 * a ) / ( 1.0 - a ),
			1.0 - ( ( 1.0 - x ) * ( 1.0 - x ) / ( 2.0 * a * ( 1.0 - a ) ) )
		);
		float threshold = ( x < ( 1.0 - a ) )
			? ( ( x < a ) ? cases.x : cases.y )
			: cases.z;
		return clamp( threshold , 1.0e-6, 1.0 );
	}
#endif`,Zx=`#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, vAlphaMapUv ).g;
#endif`,Jx=`#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,Kx=`#ifdef USE_ALPHATEST
	#ifdef ALPHA_TO_COVERAGE
	diffuseColor.a = smoothstep( alphaTest, alphaTest + fwidth( diffuseColor.a ), diffuseColor.a );
	if ( diffuseColor.a == 0.0 ) discard;
	#else
	if ( diffuseColor.a < alphaTest ) discard;
	#endif
#endif`,jx=`#ifdef USE_ALPHATEST
	uniform float alphaTest;
#endif`,Qx=`#ifdef USE_AOMAP
	float ambientOcclusion = ( texture2D( aoMap, vAoMapUv ).r - 1.0 ) * aoMapIntensity + 1.0;
	reflectedLight.indirectDiffuse *= ambientOcclusion;
	#if defined( USE_CLEARCOAT ) 
		clearcoatSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_SHEEN ) 
		sheenSpecularIndirect *= ambientOcclusion;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD )
		float dotNV = saturate( dot( geometryNormal, geometryViewDir ) );
		reflectedLight.indirectSpecular *= computeSpecularOcclusion( dotNV, ambientOcclusion, material.roughness );
	#endif
#endif`,ty=`#ifdef USE_AOMAP
	uniform sampler2D aoMap;
	uniform float aoMapIntensity;
#endif`,ey=`#ifdef USE_BATCHING
	#if ! defined( GL_ANGLE_multi_draw )
	#define gl_DrawID _gl_DrawID
	uniform int _gl_DrawID;
	#endif
	uniform highp sampler2D batchingTexture;
	uniform highp usampler2D batchingIdTexture;
	mat4 getBatchingMatrix( const in float i ) {
		int size = textureSize( batchingTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( batchingTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( batchingTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( batchingTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( batchingTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
	float getIndirectIndex( const in int i ) {
		int size = textureSize( batchingIdTexture, 0 ).x;
		int x = i % size;
		int y = i / size;
		return float( texelFetch( batchingIdTexture, ivec2( x, y ), 0 ).r );
	}
#endif
#ifdef USE_BATCHING_COLOR
	uniform sampler2D batchingColorTexture;
	vec3 getBatchingColor( const in float i ) {
		int size = textureSize( batchingColorTexture, 0 ).x;
		int j = int( i );
		int x = j % size;
		int y = j / size;
		return texelFetch( batchingColorTexture, ivec2( x, y ), 0 ).rgb;
	}
#endif`,ny=`#ifdef USE_BATCHING
	mat4 batchingMatrix = getBatchingMatrix( getIndirectIndex( gl_DrawID ) );
#endif`,iy=`vec3 transformed = vec3( position );
#ifdef USE_ALPHAHASH
	vPosition = vec3( position );
#endif`,sy=`vec3 objectNormal = vec3( normal );
#ifdef USE_TANGENT
	vec3 objectTangent = vec3( tangent.xyz );
#endif`,ry=`float G_BlinnPhong_Implicit( ) {
	return 0.25;
}
float D_BlinnPhong( const in float shininess, const in float dotNH ) {
	return RECIPROCAL_PI * ( shininess * 0.5 + 1.0 ) * pow( dotNH, shininess );
}
vec3 BRDF_BlinnPhong( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in vec3 specularColor, const in float shininess ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( specularColor, 1.0, dotVH );
	float G = G_BlinnPhong_Implicit( );
	float D = D_BlinnPhong( shininess, dotNH );
	return F * ( G * D );
} // validated`,oy=`#ifdef USE_IRIDESCENCE
	const mat3 XYZ_TO_REC709 = mat3(
		 3.2404542, -0.9692660,  0.0556434,
		-1.5371385,  1.8760108, -0.2040259,
		-0.4985314,  0.0415560,  1.0572252
	);
	vec3 Fresnel0ToIor( vec3 fresnel0 ) {
		vec3 sqrtF0 = sqrt( fresnel0 );
		return ( vec3( 1.0 ) + sqrtF0 ) / ( vec3( 1.0 ) - sqrtF0 );
	}
	vec3 IorToFresnel0( vec3 transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - vec3( incidentIor ) ) / ( transmittedIor + vec3( incidentIor ) ) );
	}
	float IorToFresnel0( float transmittedIor, float incidentIor ) {
		return pow2( ( transmittedIor - incidentIor ) / ( transmittedIor + incidentIor ));
	}
	vec3 evalSensitivity( float OPD, vec3 shift ) {
		float phase = 2.0 * PI * OPD * 1.0e-9;
		vec3 val = vec3( 5.4856e-13, 4.4201e-13, 5.2481e-13 );
		vec3 pos = vec3( 1.6810e+06, 1.7953e+06, 2.2084e+06 );
		vec3 var = vec3( 4.3278e+09, 9.3046e+09, 6.6121e+09 );
		vec3 xyz = val * sqrt( 2.0 * PI * var ) * cos( pos * phase + shift ) * exp( - pow2( phase ) * var );
		xyz.x += 9.7470e-14 * sqrt( 2.0 * PI * 4.5282e+09 ) * cos( 2.2399e+06 * phase + shift[ 0 ] ) * exp( - 4.5282e+09 * pow2( phase ) );
		xyz /= 1.0685e-7;
		vec3 rgb = XYZ_TO_REC709 * xyz;
		return rgb;
	}
	vec3 evalIridescence( float outsideIOR, float eta2, float cosTheta1, float thinFilmThickness, vec3 baseF0 ) {
		vec3 I;
		float iridescenceIOR = mix( outsideIOR, eta2, smoothstep( 0.0, 0.03, thinFilmThickness ) );
		float sinTheta2Sq = pow2( outsideIOR / iridescenceIOR ) * ( 1.0 - pow2( cosTheta1 ) );
		float cosTheta2Sq = 1.0 - sinTheta2Sq;
		if ( cosTheta2Sq < 0.0 ) {
			return vec3( 1.0 );
		}
		float cosTheta2 = sqrt( cosTheta2Sq );
		float R0 = IorToFresnel0( iridescenceIOR, outsideIOR );
		float R12 = F_Schlick( R0, 1.0, cosTheta1 );
		float T121 = 1.0 - R12;
		float phi12 = 0.0;
		if ( iridescenceIOR < outsideIOR ) phi12 = PI;
		float phi21 = PI - phi12;
		vec3 baseIOR = Fresnel0ToIor( clamp( baseF0, 0.0, 0.9999 ) );		vec3 R1 = IorToFresnel0( baseIOR, iridescenceIOR );
		vec3 R23 = F_Schlick( R1, 1.0, cosTheta2 );
		vec3 phi23 = vec3( 0.0 );
		if ( baseIOR[ 0 ] < iridescenceIOR ) phi23[ 0 ] = PI;
		if ( baseIOR[ 1 ] < iridescenceIOR ) phi23[ 1 ] = PI;
		if ( baseIOR[ 2 ] < iridescenceIOR ) phi23[ 2 ] = PI;
		float OPD = 2.0 * iridescenceIOR * thinFilmThickness * cosTheta2;
		vec3 phi = vec3( phi21 ) + phi23;
		vec3 R123 = clamp( R12 * R23, 1e-5, 0.9999 );
		vec3 r123 = sqrt( R123 );
		vec3 Rs = pow2( T121 ) * R23 / ( vec3( 1.0 ) - R123 );
		vec3 C0 = R12 + Rs;
		I = C0;
		vec3 Cm = Rs - T121;
		for ( int m = 1; m <= 2; ++ m ) {
			Cm *= r123;
			vec3 Sm = 2.0 * evalSensitivity( float( m ) * OPD, float( m ) * phi );
			I += Cm * Sm;
		}
		return max( I, vec3( 0.0 ) );
	}
#endif`,ay=`#ifdef USE_BUMPMAP
	uniform sampler2D bumpMap;
	uniform float bumpScale;
	vec2 dHdxy_fwd() {
		vec2 dSTdx = dFdx( vBumpMapUv );
		vec2 dSTdy = dFdy( vBumpMapUv );
		float Hll = bumpScale * texture2D( bumpMap, vBumpMapUv ).x;
		float dBx = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdx ).x - Hll;
		float dBy = bumpScale * texture2D( bumpMap, vBumpMapUv + dSTdy ).x - Hll;
		return vec2( dBx, dBy );
	}
	vec3 perturbNormalArb( vec3 surf_pos, vec3 surf_norm, vec2 dHdxy, float faceDirection ) {
		vec3 vSigmaX = normalize( dFdx( surf_pos.xyz ) );
		vec3 vSigmaY = normalize( dFdy( surf_pos.xyz ) );
		vec3 vN = surf_norm;
		vec3 R1 = cross( vSigmaY, vN );
		vec3 R2 = cross( vN, vSigmaX );
		float fDet = dot( vSigmaX, R1 ) * faceDirection;
		vec3 vGrad = sign( fDet ) * ( dHdxy.x * R1 + dHdxy.y * R2 );
		return normalize( abs( fDet ) * surf_norm - vGrad );
	}
#endif`,ly=`#if NUM_CLIPPING_PLANES > 0
	vec4 plane;
	#ifdef ALPHA_TO_COVERAGE
		float distanceToPlane, distanceGradient;
		float clipOpacity = 1.0;
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
			distanceGradient = fwidth( distanceToPlane ) / 2.0;
			clipOpacity *= smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			if ( clipOpacity == 0.0 ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			float unionClipOpacity = 1.0;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				distanceToPlane = - dot( vClipPosition, plane.xyz ) + plane.w;
				distanceGradient = fwidth( distanceToPlane ) / 2.0;
				unionClipOpacity *= 1.0 - smoothstep( - distanceGradient, distanceGradient, distanceToPlane );
			}
			#pragma unroll_loop_end
			clipOpacity *= 1.0 - unionClipOpacity;
		#endif
		diffuseColor.a *= clipOpacity;
		if ( diffuseColor.a == 0.0 ) discard;
	#else
		#pragma unroll_loop_start
		for ( int i = 0; i < UNION_CLIPPING_PLANES; i ++ ) {
			plane = clippingPlanes[ i ];
			if ( dot( vClipPosition, plane.xyz ) > plane.w ) discard;
		}
		#pragma unroll_loop_end
		#if UNION_CLIPPING_PLANES < NUM_CLIPPING_PLANES
			bool clipped = true;
			#pragma unroll_loop_start
			for ( int i = UNION_CLIPPING_PLANES; i < NUM_CLIPPING_PLANES; i ++ ) {
				plane = clippingPlanes[ i ];
				clipped = ( dot( vClipPosition, plane.xyz ) > plane.w ) && clipped;
			}
			#pragma unroll_loop_end
			if ( clipped ) discard;
		#endif
	#endif
#endif`,cy=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
	uniform vec4 clippingPlanes[ NUM_CLIPPING_PLANES ];
#endif`,hy=`#if NUM_CLIPPING_PLANES > 0
	varying vec3 vClipPosition;
#endif`,uy=`#if NUM_CLIPPING_PLANES > 0
	vClipPosition = - mvPosition.xyz;
#endif`,fy=`#if defined( USE_COLOR_ALPHA )
	diffuseColor *= vColor;
#elif defined( USE_COLOR )
	diffuseColor.rgb *= vColor;
#endif`,dy=`#if defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#elif defined( USE_COLOR )
	varying vec3 vColor;
#endif`,py=`#if defined( USE_COLOR_ALPHA )
	varying vec4 vColor;
#elif defined( USE_COLOR ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	varying vec3 vColor;
#endif`,my=`#if defined( USE_COLOR_ALPHA )
	vColor = vec4( 1.0 );
#elif defined( USE_COLOR ) || defined( USE_INSTANCING_COLOR ) || defined( USE_BATCHING_COLOR )
	vColor = vec3( 1.0 );
#endif
#ifdef USE_COLOR
	vColor *= color;
#endif
#ifdef USE_INSTANCING_COLOR
	vColor.xyz *= instanceColor.xyz;
#endif
#ifdef USE_BATCHING_COLOR
	vec3 batchingColor = getBatchingColor( getIndirectIndex( gl_DrawID ) );
	vColor.xyz *= batchingColor.xyz;
#endif`,gy=`#define PI 3.141592653589793
#define PI2 6.283185307179586
#define PI_HALF 1.5707963267948966
#define RECIPROCAL_PI 0.3183098861837907
#define RECIPROCAL_PI2 0.15915494309189535
#define EPSILON 1e-6
#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
#define whiteComplement( a ) ( 1.0 - saturate( a ) )
float pow2( const in float x ) { return x*x; }
vec3 pow2( const in vec3 x ) { return x*x; }
float pow3( const in float x ) { return x*x*x; }
float pow4( const in float x ) { float x2 = x*x; return x2*x2; }
float max3( const in vec3 v ) { return max( max( v.x, v.y ), v.z ); }
float average( const in vec3 v ) { return dot( v, vec3( 0.3333333 ) ); }
highp float rand( const in vec2 uv ) {
	const highp float a = 12.9898, b = 78.233, c = 43758.5453;
	highp float dt = dot( uv.xy, vec2( a,b ) ), sn = mod( dt, PI );
	return fract( sin( sn ) * c );
}
#ifdef HIGH_PRECISION
	float precisionSafeLength( vec3 v ) { return length( v ); }
#else
	float precisionSafeLength( vec3 v ) {
		float maxComponent = max3( abs( v ) );
		return length( v / maxComponent ) * maxComponent;
	}
#endif
struct IncidentLight {
	vec3 color;
	vec3 direction;
	bool visible;
};
struct ReflectedLight {
	vec3 directDiffuse;
	vec3 directSpecular;
	vec3 indirectDiffuse;
	vec3 indirectSpecular;
};
#ifdef USE_ALPHAHASH
	varying vec3 vPosition;
#endif
vec3 transformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( matrix * vec4( dir, 0.0 ) ).xyz );
}
vec3 inverseTransformDirection( in vec3 dir, in mat4 matrix ) {
	return normalize( ( vec4( dir, 0.0 ) * matrix ).xyz );
}
mat3 transposeMat3( const in mat3 m ) {
	mat3 tmp;
	tmp[ 0 ] = vec3( m[ 0 ].x, m[ 1 ].x, m[ 2 ].x );
	tmp[ 1 ] = vec3( m[ 0 ].y, m[ 1 ].y, m[ 2 ].y );
	tmp[ 2 ] = vec3( m[ 0 ].z, m[ 1 ].z, m[ 2 ].z );
	return tmp;
}
bool isPerspectiveMatrix( mat4 m ) {
	return m[ 2 ][ 3 ] == - 1.0;
}
vec2 equirectUv( in vec3 dir ) {
	float u = atan( dir.z, dir.x ) * RECIPROCAL_PI2 + 0.5;
	float v = asin( clamp( dir.y, - 1.0, 1.0 ) ) * RECIPROCAL_PI + 0.5;
	return vec2( u, v );
}
vec3 BRDF_Lambert( const in vec3 diffuseColor ) {
	return RECIPROCAL_PI * diffuseColor;
}
vec3 F_Schlick( const in vec3 f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
}
float F_Schlick( const in float f0, const in float f90, const in float dotVH ) {
	float fresnel = exp2( ( - 5.55473 * dotVH - 6.98316 ) * dotVH );
	return f0 * ( 1.0 - fresnel ) + ( f90 * fresnel );
} // validated`,_y=`#ifdef ENVMAP_TYPE_CUBE_UV
	#define cubeUV_minMipLevel 4.0
	#define cubeUV_minTileSize 16.0
	float getFace( vec3 direction ) {
		vec3 absDirection = abs( direction );
		float face = - 1.0;
		if ( absDirection.x > absDirection.z ) {
			if ( absDirection.x > absDirection.y )
				face = direction.x > 0.0 ? 0.0 : 3.0;
			else
				face = direction.y > 0.0 ? 1.0 : 4.0;
		} else {
			if ( absDirection.z > absDirection.y )
				face = direction.z > 0.0 ? 2.0 : 5.0;
			else
				face = direction.y > 0.0 ? 1.0 : 4.0;
		}
		return face;
	}
	vec2 getUV( vec3 direction, float face ) {
		vec2 uv;
		if ( face == 0.0 ) {
			uv = vec2( direction.z, direction.y ) / abs( direction.x );
		} else if ( face == 1.0 ) {
			uv = vec2( - direction.x, - direction.z ) / abs( direction.y );
		} else if ( face == 2.0 ) {
			uv = vec2( - direction.x, direction.y ) / abs( direction.z );
		} else if ( face == 3.0 ) {
			uv = vec2( - direction.z, direction.y ) / abs( direction.x );
		} else if ( face == 4.0 ) {
			uv = vec2( - direction.x, direction.z ) / abs( direction.y );
		} else {
			uv = vec2( direction.x, direction.y ) / abs( direction.z );
		}
		return 0.5 * ( uv + 1.0 );
	}
	vec3 bilinearCubeUV( sampler2D envMap, vec3 direction, float mipInt ) {
		float face = getFace( direction );
		float filterInt = max( cubeUV_minMipLevel - mipInt, 0.0 );
		mipInt = max( mipInt, cubeUV_minMipLevel );
		float faceSize = exp2( mipInt );
		highp vec2 uv = getUV( direction, face ) * ( faceSize - 2.0 ) + 1.0;
		if ( face > 2.0 ) {
			uv.y += faceSize;
			face -= 3.0;
		}
		uv.x += face * faceSize;
		uv.x += filterInt * 3.0 * cubeUV_minTileSize;
		uv.y += 4.0 * ( exp2( CUBEUV_MAX_MIP ) - faceSize );
		uv.x *= CUBEUV_TEXEL_WIDTH;
		uv.y *= CUBEUV_TEXEL_HEIGHT;
		#ifdef texture2DGradEXT
			return texture2DGradEXT( envMap, uv, vec2( 0.0 ), vec2( 0.0 ) ).rgb;
		#else
			return texture2D( envMap, uv ).rgb;
		#endif
	}
	#define cubeUV_r0 1.0
	#define cubeUV_m0 - 2.0
	#define cubeUV_r1 0.8
	#define cubeUV_m1 - 1.0
	#define cubeUV_r4 0.4
	#define cubeUV_m4 2.0
	#define cubeUV_r5 0.305
	#define cubeUV_m5 3.0
	#define cubeUV_r6 0.21
	#define cubeUV_m6 4.0
	float roughnessToMip( float roughness ) {
		float mip = 0.0;
		if ( roughness >= cubeUV_r1 ) {
			mip = ( cubeUV_r0 - roughness ) * ( cubeUV_m1 - cubeUV_m0 ) / ( cubeUV_r0 - cubeUV_r1 ) + cubeUV_m0;
		} else if ( roughness >= cubeUV_r4 ) {
			mip = ( cubeUV_r1 - roughness ) * ( cubeUV_m4 - cubeUV_m1 ) / ( cubeUV_r1 - cubeUV_r4 ) + cubeUV_m1;
		} else if ( roughness >= cubeUV_r5 ) {
			mip = ( cubeUV_r4 - roughness ) * ( cubeUV_m5 - cubeUV_m4 ) / ( cubeUV_r4 - cubeUV_r5 ) + cubeUV_m4;
		} else if ( roughness >= cubeUV_r6 ) {
			mip = ( cubeUV_r5 - roughness ) * ( cubeUV_m6 - cubeUV_m5 ) / ( cubeUV_r5 - cubeUV_r6 ) + cubeUV_m5;
		} else {
			mip = - 2.0 * log2( 1.16 * roughness );		}
		return mip;
	}
	vec4 textureCubeUV( sampler2D envMap, vec3 sampleDir, float roughness ) {
		float mip = clamp( roughnessToMip( roughness ), cubeUV_m0, CUBEUV_MAX_MIP );
		float mipF = fract( mip );
		float mipInt = floor( mip );
		vec3 color0 = bilinearCubeUV( envMap, sampleDir, mipInt );
		if ( mipF == 0.0 ) {
			return vec4( color0, 1.0 );
		} else {
			vec3 color1 = bilinearCubeUV( envMap, sampleDir, mipInt + 1.0 );
			return vec4( mix( color0, color1, mipF ), 1.0 );
		}
	}
#endif`,xy=`vec3 transformedNormal = objectNormal;
#ifdef USE_TANGENT
	vec3 transformedTangent = objectTangent;
#endif
#ifdef USE_BATCHING
	mat3 bm = mat3( batchingMatrix );
	transformedNormal /= vec3( dot( bm[ 0 ], bm[ 0 ] ), dot( bm[ 1 ], bm[ 1 ] ), dot( bm[ 2 ], bm[ 2 ] ) );
	transformedNormal = bm * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = bm * transformedTangent;
	#endif
#endif
#ifdef USE_INSTANCING
	mat3 im = mat3( instanceMatrix );
	transformedNormal /= vec3( dot( im[ 0 ], im[ 0 ] ), dot( im[ 1 ], im[ 1 ] ), dot( im[ 2 ], im[ 2 ] ) );
	transformedNormal = im * transformedNormal;
	#ifdef USE_TANGENT
		transformedTangent = im * transformedTangent;
	#endif
#endif
transformedNormal = normalMatrix * transformedNormal;
#ifdef FLIP_SIDED
	transformedNormal = - transformedNormal;
#endif
#ifdef USE_TANGENT
	transformedTangent = ( modelViewMatrix * vec4( transformedTangent, 0.0 ) ).xyz;
	#ifdef FLIP_SIDED
		transformedTangent = - transformedTangent;
	#endif
#endif`,yy=`#ifdef USE_DISPLACEMENTMAP
	uniform sampler2D displacementMap;
	uniform float displacementScale;
	uniform float displacementBias;
#endif`,vy=`#ifdef USE_DISPLACEMENTMAP
	transformed += normalize( objectNormal ) * ( texture2D( displacementMap, vDisplacementMapUv ).x * displacementScale + displacementBias );
#endif`,My=`#ifdef USE_EMISSIVEMAP
	vec4 emissiveColor = texture2D( emissiveMap, vEmissiveMapUv );
	#ifdef DECODE_VIDEO_TEXTURE_EMISSIVE
		emissiveColor = sRGBTransferEOTF( emissiveColor );
	#endif
	totalEmissiveRadiance *= emissiveColor.rgb;
#endif`,Sy=`#ifdef USE_EMISSIVEMAP
	uniform sampler2D emissiveMap;
#endif`,by="gl_FragColor = linearToOutputTexel( gl_FragColor );",wy=`vec4 LinearTransferOETF( in vec4 value ) {
	return value;
}
vec4 sRGBTransferEOTF( in vec4 value ) {
	return vec4( mix( pow( value.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), value.rgb * 0.0773993808, vec3( lessThanEqual( value.rgb, vec3( 0.04045 ) ) ) ), value.a );
}
vec4 sRGBTransferOETF( in vec4 value ) {
	return vec4( mix( pow( value.rgb, vec3( 0.41666 ) ) * 1.055 - vec3( 0.055 ), value.rgb * 12.92, vec3( lessThanEqual( value.rgb, vec3( 0.0031308 ) ) ) ), value.a );
}`,Ey=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vec3 cameraToFrag;
		if ( isOrthographic ) {
			cameraToFrag = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToFrag = normalize( vWorldPosition - cameraPosition );
		}
		vec3 worldNormal = inverseTransformDirection( normal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vec3 reflectVec = reflect( cameraToFrag, worldNormal );
		#else
			vec3 reflectVec = refract( cameraToFrag, worldNormal, refractionRatio );
		#endif
	#else
		vec3 reflectVec = vReflect;
	#endif
	#ifdef ENVMAP_TYPE_CUBE
		vec4 envColor = textureCube( envMap, envMapRotation * vec3( flipEnvMap * reflectVec.x, reflectVec.yz ) );
	#else
		vec4 envColor = vec4( 0.0 );
	#endif
	#ifdef ENVMAP_BLENDING_MULTIPLY
		outgoingLight = mix( outgoingLight, outgoingLight * envColor.xyz, specularStrength * reflectivity );
	#elif defined( ENVMAP_BLENDING_MIX )
		outgoingLight = mix( outgoingLight, envColor.xyz, specularStrength * reflectivity );
	#elif defined( ENVMAP_BLENDING_ADD )
		outgoingLight += envColor.xyz * specularStrength * reflectivity;
	#endif
#endif`,Ty=`#ifdef USE_ENVMAP
	uniform float envMapIntensity;
	uniform float flipEnvMap;
	uniform mat3 envMapRotation;
	#ifdef ENVMAP_TYPE_CUBE
		uniform samplerCube envMap;
	#else
		uniform sampler2D envMap;
	#endif
	
#endif`,Ay=`#ifdef USE_ENVMAP
	uniform float reflectivity;
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		varying vec3 vWorldPosition;
		uniform float refractionRatio;
	#else
		varying vec3 vReflect;
	#endif
#endif`,Cy=`#ifdef USE_ENVMAP
	#if defined( USE_BUMPMAP ) || defined( USE_NORMALMAP ) || defined( PHONG ) || defined( LAMBERT )
		#define ENV_WORLDPOS
	#endif
	#ifdef ENV_WORLDPOS
		
		varying vec3 vWorldPosition;
	#else
		varying vec3 vReflect;
		uniform float refractionRatio;
	#endif
#endif`,Ry=`#ifdef USE_ENVMAP
	#ifdef ENV_WORLDPOS
		vWorldPosition = worldPosition.xyz;
	#else
		vec3 cameraToVertex;
		if ( isOrthographic ) {
			cameraToVertex = normalize( vec3( - viewMatrix[ 0 ][ 2 ], - viewMatrix[ 1 ][ 2 ], - viewMatrix[ 2 ][ 2 ] ) );
		} else {
			cameraToVertex = normalize( worldPosition.xyz - cameraPosition );
		}
		vec3 worldNormal = inverseTransformDirection( transformedNormal, viewMatrix );
		#ifdef ENVMAP_MODE_REFLECTION
			vReflect = reflect( cameraToVertex, worldNormal );
		#else
			vReflect = refract( cameraToVertex, worldNormal, refractionRatio );
		#endif
	#endif
#endif`,Py=`#ifdef USE_FOG
	vFogDepth = - mvPosition.z;
#endif`,Iy=`#ifdef USE_FOG
	varying float vFogDepth;
#endif`,Ly=`#ifdef USE_FOG
	#ifdef FOG_EXP2
		float fogFactor = 1.0 - exp( - fogDensity * fogDensity * vFogDepth * vFogDepth );
	#else
		float fogFactor = smoothstep( fogNear, fogFar, vFogDepth );
	#endif
	gl_FragColor.rgb = mix( gl_FragColor.rgb, fogColor, fogFactor );
#endif`,Dy=`#ifdef USE_FOG
	uniform vec3 fogColor;
	varying float vFogDepth;
	#ifdef FOG_EXP2
		uniform float fogDensity;
	#else
		uniform float fogNear;
		uniform float fogFar;
	#endif
#endif`,Uy=`#ifdef USE_GRADIENTMAP
	uniform sampler2D gradientMap;
#endif
vec3 getGradientIrradiance( vec3 normal, vec3 lightDirection ) {
	float dotNL = dot( normal, lightDirection );
	vec2 coord = vec2( dotNL * 0.5 + 0.5, 0.0 );
	#ifdef USE_GRADIENTMAP
		return vec3( texture2D( gradientMap, coord ).r );
	#else
		vec2 fw = fwidth( coord ) * 0.5;
		return mix( vec3( 0.7 ), vec3( 1.0 ), smoothstep( 0.7 - fw.x, 0.7 + fw.x, coord.x ) );
	#endif
}`,Ny=`#ifdef USE_LIGHTMAP
	uniform sampler2D lightMap;
	uniform float lightMapIntensity;
#endif`,Oy=`LambertMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularStrength = specularStrength;`,Fy=`varying vec3 vViewPosition;
struct LambertMaterial {
	vec3 diffuseColor;
	float specularStrength;
};
void RE_Direct_Lambert( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Lambert( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in LambertMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Lambert
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Lambert`,By=`uniform bool receiveShadow;
uniform vec3 ambientLightColor;
#if defined( USE_LIGHT_PROBES )
	uniform vec3 lightProbe[ 9 ];
#endif
vec3 shGetIrradianceAt( in vec3 normal, in vec3 shCoefficients[ 9 ] ) {
	float x = normal.x, y = normal.y, z = normal.z;
	vec3 result = shCoefficients[ 0 ] * 0.886227;
	result += shCoefficients[ 1 ] * 2.0 * 0.511664 * y;
	result += shCoefficients[ 2 ] * 2.0 * 0.511664 * z;
	result += shCoefficients[ 3 ] * 2.0 * 0.511664 * x;
	result += shCoefficients[ 4 ] * 2.0 * 0.429043 * x * y;
	result += shCoefficients[ 5 ] * 2.0 * 0.429043 * y * z;
	result += shCoefficients[ 6 ] * ( 0.743125 * z * z - 0.247708 );
	result += shCoefficients[ 7 ] * 2.0 * 0.429043 * x * z;
	result += shCoefficients[ 8 ] * 0.429043 * ( x * x - y * y );
	return result;
}
vec3 getLightProbeIrradiance( const in vec3 lightProbe[ 9 ], const in vec3 normal ) {
	vec3 worldNormal = inverseTransformDirection( normal, viewMatrix );
	vec3 irradiance = shGetIrradianceAt( worldNormal, lightProbe );
	return irradiance;
}
vec3 getAmbientLightIrradiance( const in vec3 ambientLightColor ) {
	vec3 irradiance = ambientLightColor;
	return irradiance;
}
float getDistanceAttenuation( const in float lightDistance, const in float cutoffDistance, const in float decayExponent ) {
	float distanceFalloff = 1.0 / max( pow( lightDistance, decayExponent ), 0.01 );
	if ( cutoffDistance > 0.0 ) {
		distanceFalloff *= pow2( saturate( 1.0 - pow4( lightDistance / cutoffDistance ) ) );
	}
	return distanceFalloff;
}
float getSpotAttenuation( const in float coneCosine, const in float penumbraCosine, const in float angleCosine ) {
	return smoothstep( coneCosine, penumbraCosine, angleCosine );
}
#if NUM_DIR_LIGHTS > 0
	struct DirectionalLight {
		vec3 direction;
		vec3 color;
	};
	uniform DirectionalLight directionalLights[ NUM_DIR_LIGHTS ];
	void getDirectionalLightInfo( const in DirectionalLight directionalLight, out IncidentLight light ) {
		light.color = directionalLight.color;
		light.direction = directionalLight.direction;
		light.visible = true;
	}
#endif
#if NUM_POINT_LIGHTS > 0
	struct PointLight {
		vec3 position;
		vec3 color;
		float distance;
		float decay;
	};
	uniform PointLight pointLights[ NUM_POINT_LIGHTS ];
	void getPointLightInfo( const in PointLight pointLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = pointLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float lightDistance = length( lVector );
		light.color = pointLight.color;
		light.color *= getDistanceAttenuation( lightDistance, pointLight.distance, pointLight.decay );
		light.visible = ( light.color != vec3( 0.0 ) );
	}
#endif
#if NUM_SPOT_LIGHTS > 0
	struct SpotLight {
		vec3 position;
		vec3 direction;
		vec3 color;
		float distance;
		float decay;
		float coneCos;
		float penumbraCos;
	};
	uniform SpotLight spotLights[ NUM_SPOT_LIGHTS ];
	void getSpotLightInfo( const in SpotLight spotLight, const in vec3 geometryPosition, out IncidentLight light ) {
		vec3 lVector = spotLight.position - geometryPosition;
		light.direction = normalize( lVector );
		float angleCos = dot( light.direction, spotLight.direction );
		float spotAttenuation = getSpotAttenuation( spotLight.coneCos, spotLight.penumbraCos, angleCos );
		if ( spotAttenuation > 0.0 ) {
			float lightDistance = length( lVector );
			light.color = spotLight.color * spotAttenuation;
			light.color *= getDistanceAttenuation( lightDistance, spotLight.distance, spotLight.decay );
			light.visible = ( light.color != vec3( 0.0 ) );
		} else {
			light.color = vec3( 0.0 );
			light.visible = false;
		}
	}
#endif
#if NUM_RECT_AREA_LIGHTS > 0
	struct RectAreaLight {
		vec3 color;
		vec3 position;
		vec3 halfWidth;
		vec3 halfHeight;
	};
	uniform sampler2D ltc_1;	uniform sampler2D ltc_2;
	uniform RectAreaLight rectAreaLights[ NUM_RECT_AREA_LIGHTS ];
#endif
#if NUM_HEMI_LIGHTS > 0
	struct HemisphereLight {
		vec3 direction;
		vec3 skyColor;
		vec3 groundColor;
	};
	uniform HemisphereLight hemisphereLights[ NUM_HEMI_LIGHTS ];
	vec3 getHemisphereLightIrradiance( const in HemisphereLight hemiLight, const in vec3 normal ) {
		float dotNL = dot( normal, hemiLight.direction );
		float hemiDiffuseWeight = 0.5 * dotNL + 0.5;
		vec3 irradiance = mix( hemiLight.groundColor, hemiLight.skyColor, hemiDiffuseWeight );
		return irradiance;
	}
#endif`,ky=`#ifdef USE_ENVMAP
	vec3 getIBLIrradiance( const in vec3 normal ) {
		#ifdef ENVMAP_TYPE_CUBE_UV
			vec3 worldNormal = inverseTransformDirection( normal, viewMatrix );
			vec4 envMapColor = textureCubeUV( envMap, envMapRotation * worldNormal, 1.0 );
			return PI * envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	vec3 getIBLRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness ) {
		#ifdef ENVMAP_TYPE_CUBE_UV
			vec3 reflectVec = reflect( - viewDir, normal );
			reflectVec = normalize( mix( reflectVec, normal, roughness * roughness) );
			reflectVec = inverseTransformDirection( reflectVec, viewMatrix );
			vec4 envMapColor = textureCubeUV( envMap, envMapRotation * reflectVec, roughness );
			return envMapColor.rgb * envMapIntensity;
		#else
			return vec3( 0.0 );
		#endif
	}
	#ifdef USE_ANISOTROPY
		vec3 getIBLAnisotropyRadiance( const in vec3 viewDir, const in vec3 normal, const in float roughness, const in vec3 bitangent, const in float anisotropy ) {
			#ifdef ENVMAP_TYPE_CUBE_UV
				vec3 bentNormal = cross( bitangent, viewDir );
				bentNormal = normalize( cross( bentNormal, bitangent ) );
				bentNormal = normalize( mix( bentNormal, normal, pow2( pow2( 1.0 - anisotropy * ( 1.0 - roughness ) ) ) ) );
				return getIBLRadiance( viewDir, bentNormal, roughness );
			#else
				return vec3( 0.0 );
			#endif
		}
	#endif
#endif`,zy=`ToonMaterial material;
material.diffuseColor = diffuseColor.rgb;`,Vy=`varying vec3 vViewPosition;
struct ToonMaterial {
	vec3 diffuseColor;
};
void RE_Direct_Toon( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	vec3 irradiance = getGradientIrradiance( geometryNormal, directLight.direction ) * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Toon( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in ToonMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_Toon
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Toon`,Hy=`BlinnPhongMaterial material;
material.diffuseColor = diffuseColor.rgb;
material.specularColor = specular;
material.specularShininess = shininess;
material.specularStrength = specularStrength;`,Gy=`varying vec3 vViewPosition;
struct BlinnPhongMaterial {
	vec3 diffuseColor;
	vec3 specularColor;
	float specularShininess;
	float specularStrength;
};
void RE_Direct_BlinnPhong( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
	reflectedLight.directSpecular += irradiance * BRDF_BlinnPhong( directLight.direction, geometryViewDir, geometryNormal, material.specularColor, material.specularShininess ) * material.specularStrength;
}
void RE_IndirectDiffuse_BlinnPhong( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in BlinnPhongMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
#define RE_Direct				RE_Direct_BlinnPhong
#define RE_IndirectDiffuse		RE_IndirectDiffuse_BlinnPhong`,Wy=`PhysicalMaterial material;
material.diffuseColor = diffuseColor.rgb * ( 1.0 - metalnessFactor );
vec3 dxy = max( abs( dFdx( nonPerturbedNormal ) ), abs( dFdy( nonPerturbedNormal ) ) );
float geometryRoughness = max( max( dxy.x, dxy.y ), dxy.z );
material.roughness = max( roughnessFactor, 0.0525 );material.roughness += geometryRoughness;
material.roughness = min( material.roughness, 1.0 );
#ifdef IOR
	material.ior = ior;
	#ifdef USE_SPECULAR
		float specularIntensityFactor = specularIntensity;
		vec3 specularColorFactor = specularColor;
		#ifdef USE_SPECULAR_COLORMAP
			specularColorFactor *= texture2D( specularColorMap, vSpecularColorMapUv ).rgb;
		#endif
		#ifdef USE_SPECULAR_INTENSITYMAP
			specularIntensityFactor *= texture2D( specularIntensityMap, vSpecularIntensityMapUv ).a;
		#endif
		material.specularF90 = mix( specularIntensityFactor, 1.0, metalnessFactor );
	#else
		float specularIntensityFactor = 1.0;
		vec3 specularColorFactor = vec3( 1.0 );
		material.specularF90 = 1.0;
	#endif
	material.specularColor = mix( min( pow2( ( material.ior - 1.0 ) / ( material.ior + 1.0 ) ) * specularColorFactor, vec3( 1.0 ) ) * specularIntensityFactor, diffuseColor.rgb, metalnessFactor );
#else
	material.specularColor = mix( vec3( 0.04 ), diffuseColor.rgb, metalnessFactor );
	material.specularF90 = 1.0;
#endif
#ifdef USE_CLEARCOAT
	material.clearcoat = clearcoat;
	material.clearcoatRoughness = clearcoatRoughness;
	material.clearcoatF0 = vec3( 0.04 );
	material.clearcoatF90 = 1.0;
	#ifdef USE_CLEARCOATMAP
		material.clearcoat *= texture2D( clearcoatMap, vClearcoatMapUv ).x;
	#endif
	#ifdef USE_CLEARCOAT_ROUGHNESSMAP
		material.clearcoatRoughness *= texture2D( clearcoatRoughnessMap, vClearcoatRoughnessMapUv ).y;
	#endif
	material.clearcoat = saturate( material.clearcoat );	material.clearcoatRoughness = max( material.clearcoatRoughness, 0.0525 );
	material.clearcoatRoughness += geometryRoughness;
	material.clearcoatRoughness = min( material.clearcoatRoughness, 1.0 );
#endif
#ifdef USE_DISPERSION
	material.dispersion = dispersion;
#endif
#ifdef USE_IRIDESCENCE
	material.iridescence = iridescence;
	material.iridescenceIOR = iridescenceIOR;
	#ifdef USE_IRIDESCENCEMAP
		material.iridescence *= texture2D( iridescenceMap, vIridescenceMapUv ).r;
	#endif
	#ifdef USE_IRIDESCENCE_THICKNESSMAP
		material.iridescenceThickness = (iridescenceThicknessMaximum - iridescenceThicknessMinimum) * texture2D( iridescenceThicknessMap, vIridescenceThicknessMapUv ).g + iridescenceThicknessMinimum;
	#else
		material.iridescenceThickness = iridescenceThicknessMaximum;
	#endif
#endif
#ifdef USE_SHEEN
	material.sheenColor = sheenColor;
	#ifdef USE_SHEEN_COLORMAP
		material.sheenColor *= texture2D( sheenColorMap, vSheenColorMapUv ).rgb;
	#endif
	material.sheenRoughness = clamp( sheenRoughness, 0.07, 1.0 );
	#ifdef USE_SHEEN_ROUGHNESSMAP
		material.sheenRoughness *= texture2D( sheenRoughnessMap, vSheenRoughnessMapUv ).a;
	#endif
#endif
#ifdef USE_ANISOTROPY
	#ifdef USE_ANISOTROPYMAP
		mat2 anisotropyMat = mat2( anisotropyVector.x, anisotropyVector.y, - anisotropyVector.y, anisotropyVector.x );
		vec3 anisotropyPolar = texture2D( anisotropyMap, vAnisotropyMapUv ).rgb;
		vec2 anisotropyV = anisotropyMat * normalize( 2.0 * anisotropyPolar.rg - vec2( 1.0 ) ) * anisotropyPolar.b;
	#else
		vec2 anisotropyV = anisotropyVector;
	#endif
	material.anisotropy = length( anisotropyV );
	if( material.anisotropy == 0.0 ) {
		anisotropyV = vec2( 1.0, 0.0 );
	} else {
		anisotropyV /= material.anisotropy;
		material.anisotropy = saturate( material.anisotropy );
	}
	material.alphaT = mix( pow2( material.roughness ), 1.0, pow2( material.anisotropy ) );
	material.anisotropyT = tbn[ 0 ] * anisotropyV.x + tbn[ 1 ] * anisotropyV.y;
	material.anisotropyB = tbn[ 1 ] * anisotropyV.x - tbn[ 0 ] * anisotropyV.y;
#endif`,Xy=`struct PhysicalMaterial {
	vec3 diffuseColor;
	float roughness;
	vec3 specularColor;
	float specularF90;
	float dispersion;
	#ifdef USE_CLEARCOAT
		float clearcoat;
		float clearcoatRoughness;
		vec3 clearcoatF0;
		float clearcoatF90;
	#endif
	#ifdef USE_IRIDESCENCE
		float iridescence;
		float iridescenceIOR;
		float iridescenceThickness;
		vec3 iridescenceFresnel;
		vec3 iridescenceF0;
	#endif
	#ifdef USE_SHEEN
		vec3 sheenColor;
		float sheenRoughness;
	#endif
	#ifdef IOR
		float ior;
	#endif
	#ifdef USE_TRANSMISSION
		float transmission;
		float transmissionAlpha;
		float thickness;
		float attenuationDistance;
		vec3 attenuationColor;
	#endif
	#ifdef USE_ANISOTROPY
		float anisotropy;
		float alphaT;
		vec3 anisotropyT;
		vec3 anisotropyB;
	#endif
};
vec3 clearcoatSpecularDirect = vec3( 0.0 );
vec3 clearcoatSpecularIndirect = vec3( 0.0 );
vec3 sheenSpecularDirect = vec3( 0.0 );
vec3 sheenSpecularIndirect = vec3(0.0 );
vec3 Schlick_to_F0( const in vec3 f, const in float f90, const in float dotVH ) {
    float x = clamp( 1.0 - dotVH, 0.0, 1.0 );
    float x2 = x * x;
    float x5 = clamp( x * x2 * x2, 0.0, 0.9999 );
    return ( f - vec3( f90 ) * x5 ) / ( 1.0 - x5 );
}
float V_GGX_SmithCorrelated( const in float alpha, const in float dotNL, const in float dotNV ) {
	float a2 = pow2( alpha );
	float gv = dotNL * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNV ) );
	float gl = dotNV * sqrt( a2 + ( 1.0 - a2 ) * pow2( dotNL ) );
	return 0.5 / max( gv + gl, EPSILON );
}
float D_GGX( const in float alpha, const in float dotNH ) {
	float a2 = pow2( alpha );
	float denom = pow2( dotNH ) * ( a2 - 1.0 ) + 1.0;
	return RECIPROCAL_PI * a2 / pow2( denom );
}
#ifdef USE_ANISOTROPY
	float V_GGX_SmithCorrelated_Anisotropic( const in float alphaT, const in float alphaB, const in float dotTV, const in float dotBV, const in float dotTL, const in float dotBL, const in float dotNV, const in float dotNL ) {
		float gv = dotNL * length( vec3( alphaT * dotTV, alphaB * dotBV, dotNV ) );
		float gl = dotNV * length( vec3( alphaT * dotTL, alphaB * dotBL, dotNL ) );
		float v = 0.5 / ( gv + gl );
		return saturate(v);
	}
	float D_GGX_Anisotropic( const in float alphaT, const in float alphaB, const in float dotNH, const in float dotTH, const in float dotBH ) {
		float a2 = alphaT * alphaB;
		highp vec3 v = vec3( alphaB * dotTH, alphaT * dotBH, a2 * dotNH );
		highp float v2 = dot( v, v );
		float w2 = a2 / v2;
		return RECIPROCAL_PI * a2 * pow2 ( w2 );
	}
#endif
#ifdef USE_CLEARCOAT
	vec3 BRDF_GGX_Clearcoat( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material) {
		vec3 f0 = material.clearcoatF0;
		float f90 = material.clearcoatF90;
		float roughness = material.clearcoatRoughness;
		float alpha = pow2( roughness );
		vec3 halfDir = normalize( lightDir + viewDir );
		float dotNL = saturate( dot( normal, lightDir ) );
		float dotNV = saturate( dot( normal, viewDir ) );
		float dotNH = saturate( dot( normal, halfDir ) );
		float dotVH = saturate( dot( viewDir, halfDir ) );
		vec3 F = F_Schlick( f0, f90, dotVH );
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
		return F * ( V * D );
	}
#endif
vec3 BRDF_GGX( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, const in PhysicalMaterial material ) {
	vec3 f0 = material.specularColor;
	float f90 = material.specularF90;
	float roughness = material.roughness;
	float alpha = pow2( roughness );
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float dotVH = saturate( dot( viewDir, halfDir ) );
	vec3 F = F_Schlick( f0, f90, dotVH );
	#ifdef USE_IRIDESCENCE
		F = mix( F, material.iridescenceFresnel, material.iridescence );
	#endif
	#ifdef USE_ANISOTROPY
		float dotTL = dot( material.anisotropyT, lightDir );
		float dotTV = dot( material.anisotropyT, viewDir );
		float dotTH = dot( material.anisotropyT, halfDir );
		float dotBL = dot( material.anisotropyB, lightDir );
		float dotBV = dot( material.anisotropyB, viewDir );
		float dotBH = dot( material.anisotropyB, halfDir );
		float V = V_GGX_SmithCorrelated_Anisotropic( material.alphaT, alpha, dotTV, dotBV, dotTL, dotBL, dotNV, dotNL );
		float D = D_GGX_Anisotropic( material.alphaT, alpha, dotNH, dotTH, dotBH );
	#else
		float V = V_GGX_SmithCorrelated( alpha, dotNL, dotNV );
		float D = D_GGX( alpha, dotNH );
	#endif
	return F * ( V * D );
}
vec2 LTC_Uv( const in vec3 N, const in vec3 V, const in float roughness ) {
	const float LUT_SIZE = 64.0;
	const float LUT_SCALE = ( LUT_SIZE - 1.0 ) / LUT_SIZE;
	const float LUT_BIAS = 0.5 / LUT_SIZE;
	float dotNV = saturate( dot( N, V ) );
	vec2 uv = vec2( roughness, sqrt( 1.0 - dotNV ) );
	uv = uv * LUT_SCALE + LUT_BIAS;
	return uv;
}
float LTC_ClippedSphereFormFactor( const in vec3 f ) {
	float l = length( f );
	return max( ( l * l + f.z ) / ( l + 1.0 ), 0.0 );
}
vec3 LTC_EdgeVectorFormFactor( const in vec3 v1, const in vec3 v2 ) {
	float x = dot( v1, v2 );
	float y = abs( x );
	float a = 0.8543985 + ( 0.4965155 + 0.0145206 * y ) * y;
	float b = 3.4175940 + ( 4.1616724 + y ) * y;
	float v = a / b;
	float theta_sintheta = ( x > 0.0 ) ? v : 0.5 * inversesqrt( max( 1.0 - x * x, 1e-7 ) ) - v;
	return cross( v1, v2 ) * theta_sintheta;
}
vec3 LTC_Evaluate( const in vec3 N, const in vec3 V, const in vec3 P, const in mat3 mInv, const in vec3 rectCoords[ 4 ] ) {
	vec3 v1 = rectCoords[ 1 ] - rectCoords[ 0 ];
	vec3 v2 = rectCoords[ 3 ] - rectCoords[ 0 ];
	vec3 lightNormal = cross( v1, v2 );
	if( dot( lightNormal, P - rectCoords[ 0 ] ) < 0.0 ) return vec3( 0.0 );
	vec3 T1, T2;
	T1 = normalize( V - N * dot( V, N ) );
	T2 = - cross( N, T1 );
	mat3 mat = mInv * transposeMat3( mat3( T1, T2, N ) );
	vec3 coords[ 4 ];
	coords[ 0 ] = mat * ( rectCoords[ 0 ] - P );
	coords[ 1 ] = mat * ( rectCoords[ 1 ] - P );
	coords[ 2 ] = mat * ( rectCoords[ 2 ] - P );
	coords[ 3 ] = mat * ( rectCoords[ 3 ] - P );
	coords[ 0 ] = normalize( coords[ 0 ] );
	coords[ 1 ] = normalize( coords[ 1 ] );
	coords[ 2 ] = normalize( coords[ 2 ] );
	coords[ 3 ] = normalize( coords[ 3 ] );
	vec3 vectorFormFactor = vec3( 0.0 );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 0 ], coords[ 1 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 1 ], coords[ 2 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 2 ], coords[ 3 ] );
	vectorFormFactor += LTC_EdgeVectorFormFactor( coords[ 3 ], coords[ 0 ] );
	float result = LTC_ClippedSphereFormFactor( vectorFormFactor );
	return vec3( result );
}
#if defined( USE_SHEEN )
float D_Charlie( float roughness, float dotNH ) {
	float alpha = pow2( roughness );
	float invAlpha = 1.0 / alpha;
	float cos2h = dotNH * dotNH;
	float sin2h = max( 1.0 - cos2h, 0.0078125 );
	return ( 2.0 + invAlpha ) * pow( sin2h, invAlpha * 0.5 ) / ( 2.0 * PI );
}
float V_Neubelt( float dotNV, float dotNL ) {
	return saturate( 1.0 / ( 4.0 * ( dotNL + dotNV - dotNL * dotNV ) ) );
}
vec3 BRDF_Sheen( const in vec3 lightDir, const in vec3 viewDir, const in vec3 normal, vec3 sheenColor, const in float sheenRoughness ) {
	vec3 halfDir = normalize( lightDir + viewDir );
	float dotNL = saturate( dot( normal, lightDir ) );
	float dotNV = saturate( dot( normal, viewDir ) );
	float dotNH = saturate( dot( normal, halfDir ) );
	float D = D_Charlie( sheenRoughness, dotNH );
	float V = V_Neubelt( dotNV, dotNL );
	return sheenColor * ( D * V );
}
#endif
float IBLSheenBRDF( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	float r2 = roughness * roughness;
	float a = roughness < 0.25 ? -339.2 * r2 + 161.4 * roughness - 25.9 : -8.48 * r2 + 14.3 * roughness - 9.95;
	float b = roughness < 0.25 ? 44.0 * r2 - 23.7 * roughness + 3.26 : 1.97 * r2 - 3.27 * roughness + 0.72;
	float DG = exp( a * dotNV + b ) + ( roughness < 0.25 ? 0.0 : 0.1 * ( roughness - 0.25 ) );
	return saturate( DG * RECIPROCAL_PI );
}
vec2 DFGApprox( const in vec3 normal, const in vec3 viewDir, const in float roughness ) {
	float dotNV = saturate( dot( normal, viewDir ) );
	const vec4 c0 = vec4( - 1, - 0.0275, - 0.572, 0.022 );
	const vec4 c1 = vec4( 1, 0.0425, 1.04, - 0.04 );
	vec4 r = roughness * c0 + c1;
	float a004 = min( r.x * r.x, exp2( - 9.28 * dotNV ) ) * r.x + r.y;
	vec2 fab = vec2( - 1.04, 1.04 ) * a004 + r.zw;
	return fab;
}
vec3 EnvironmentBRDF( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness ) {
	vec2 fab = DFGApprox( normal, viewDir, roughness );
	return specularColor * fab.x + specularF90 * fab.y;
}
#ifdef USE_IRIDESCENCE
void computeMultiscatteringIridescence( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float iridescence, const in vec3 iridescenceF0, const in float roughness, inout vec3 singleScatter, inout vec3 multiScatter ) {
#else
void computeMultiscattering( const in vec3 normal, const in vec3 viewDir, const in vec3 specularColor, const in float specularF90, const in float roughness, inout vec3 singleScatter, inout vec3 multiScatter ) {
#endif
	vec2 fab = DFGApprox( normal, viewDir, roughness );
	#ifdef USE_IRIDESCENCE
		vec3 Fr = mix( specularColor, iridescenceF0, iridescence );
	#else
		vec3 Fr = specularColor;
	#endif
	vec3 FssEss = Fr * fab.x + specularF90 * fab.y;
	float Ess = fab.x + fab.y;
	float Ems = 1.0 - Ess;
	vec3 Favg = Fr + ( 1.0 - Fr ) * 0.047619;	vec3 Fms = FssEss * Favg / ( 1.0 - Ems * Favg );
	singleScatter += FssEss;
	multiScatter += Fms * Ems;
}
#if NUM_RECT_AREA_LIGHTS > 0
	void RE_Direct_RectArea_Physical( const in RectAreaLight rectAreaLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
		vec3 normal = geometryNormal;
		vec3 viewDir = geometryViewDir;
		vec3 position = geometryPosition;
		vec3 lightPos = rectAreaLight.position;
		vec3 halfWidth = rectAreaLight.halfWidth;
		vec3 halfHeight = rectAreaLight.halfHeight;
		vec3 lightColor = rectAreaLight.color;
		float roughness = material.roughness;
		vec3 rectCoords[ 4 ];
		rectCoords[ 0 ] = lightPos + halfWidth - halfHeight;		rectCoords[ 1 ] = lightPos - halfWidth - halfHeight;
		rectCoords[ 2 ] = lightPos - halfWidth + halfHeight;
		rectCoords[ 3 ] = lightPos + halfWidth + halfHeight;
		vec2 uv = LTC_Uv( normal, viewDir, roughness );
		vec4 t1 = texture2D( ltc_1, uv );
		vec4 t2 = texture2D( ltc_2, uv );
		mat3 mInv = mat3(
			vec3( t1.x, 0, t1.y ),
			vec3(    0, 1,    0 ),
			vec3( t1.z, 0, t1.w )
		);
		vec3 fresnel = ( material.specularColor * t2.x + ( vec3( 1.0 ) - material.specularColor ) * t2.y );
		reflectedLight.directSpecular += lightColor * fresnel * LTC_Evaluate( normal, viewDir, position, mInv, rectCoords );
		reflectedLight.directDiffuse += lightColor * material.diffuseColor * LTC_Evaluate( normal, viewDir, position, mat3( 1.0 ), rectCoords );
	}
#endif
void RE_Direct_Physical( const in IncidentLight directLight, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	float dotNL = saturate( dot( geometryNormal, directLight.direction ) );
	vec3 irradiance = dotNL * directLight.color;
	#ifdef USE_CLEARCOAT
		float dotNLcc = saturate( dot( geometryClearcoatNormal, directLight.direction ) );
		vec3 ccIrradiance = dotNLcc * directLight.color;
		clearcoatSpecularDirect += ccIrradiance * BRDF_GGX_Clearcoat( directLight.direction, geometryViewDir, geometryClearcoatNormal, material );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularDirect += irradiance * BRDF_Sheen( directLight.direction, geometryViewDir, geometryNormal, material.sheenColor, material.sheenRoughness );
	#endif
	reflectedLight.directSpecular += irradiance * BRDF_GGX( directLight.direction, geometryViewDir, geometryNormal, material );
	reflectedLight.directDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectDiffuse_Physical( const in vec3 irradiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight ) {
	reflectedLight.indirectDiffuse += irradiance * BRDF_Lambert( material.diffuseColor );
}
void RE_IndirectSpecular_Physical( const in vec3 radiance, const in vec3 irradiance, const in vec3 clearcoatRadiance, const in vec3 geometryPosition, const in vec3 geometryNormal, const in vec3 geometryViewDir, const in vec3 geometryClearcoatNormal, const in PhysicalMaterial material, inout ReflectedLight reflectedLight) {
	#ifdef USE_CLEARCOAT
		clearcoatSpecularIndirect += clearcoatRadiance * EnvironmentBRDF( geometryClearcoatNormal, geometryViewDir, material.clearcoatF0, material.clearcoatF90, material.clearcoatRoughness );
	#endif
	#ifdef USE_SHEEN
		sheenSpecularIndirect += irradiance * material.sheenColor * IBLSheenBRDF( geometryNormal, geometryViewDir, material.sheenRoughness );
	#endif
	vec3 singleScattering = vec3( 0.0 );
	vec3 multiScattering = vec3( 0.0 );
	vec3 cosineWeightedIrradiance = irradiance * RECIPROCAL_PI;
	#ifdef USE_IRIDESCENCE
		computeMultiscatteringIridescence( geometryNormal, geometryViewDir, material.specularColor, material.specularF90, material.iridescence, material.iridescenceFresnel, material.roughness, singleScattering, multiScattering );
	#else
		computeMultiscattering( geometryNormal, geometryViewDir, material.specularColor, material.specularF90, material.roughness, singleScattering, multiScattering );
	#endif
	vec3 totalScattering = singleScattering + multiScattering;
	vec3 diffuse = material.diffuseColor * ( 1.0 - max( max( totalScattering.r, totalScattering.g ), totalScattering.b ) );
	reflectedLight.indirectSpecular += radiance * singleScattering;
	reflectedLight.indirectSpecular += multiScattering * cosineWeightedIrradiance;
	reflectedLight.indirectDiffuse += diffuse * cosineWeightedIrradiance;
}
#define RE_Direct				RE_Direct_Physical
#define RE_Direct_RectArea		RE_Direct_RectArea_Physical
#define RE_IndirectDiffuse		RE_IndirectDiffuse_Physical
#define RE_IndirectSpecular		RE_IndirectSpecular_Physical
float computeSpecularOcclusion( const in float dotNV, const in float ambientOcclusion, const in float roughness ) {
	return saturate( pow( dotNV + ambientOcclusion, exp2( - 16.0 * roughness - 1.0 ) ) - 1.0 + ambientOcclusion );
}`,qy=`
vec3 geometryPosition = - vViewPosition;
vec3 geometryNormal = normal;
vec3 geometryViewDir = ( isOrthographic ) ? vec3( 0, 0, 1 ) : normalize( vViewPosition );
vec3 geometryClearcoatNormal = vec3( 0.0 );
#ifdef USE_CLEARCOAT
	geometryClearcoatNormal = clearcoatNormal;
#endif
#ifdef USE_IRIDESCENCE
	float dotNVi = saturate( dot( normal, geometryViewDir ) );
	if ( material.iridescenceThickness == 0.0 ) {
		material.iridescence = 0.0;
	} else {
		material.iridescence = saturate( material.iridescence );
	}
	if ( material.iridescence > 0.0 ) {
		material.iridescenceFresnel = evalIridescence( 1.0, material.iridescenceIOR, dotNVi, material.iridescenceThickness, material.specularColor );
		material.iridescenceF0 = Schlick_to_F0( material.iridescenceFresnel, 1.0, dotNVi );
	}
#endif
IncidentLight directLight;
#if ( NUM_POINT_LIGHTS > 0 ) && defined( RE_Direct )
	PointLight pointLight;
	#if defined( USE_SHADOWMAP ) && NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHTS; i ++ ) {
		pointLight = pointLights[ i ];
		getPointLightInfo( pointLight, geometryPosition, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_POINT_LIGHT_SHADOWS )
		pointLightShadow = pointLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getPointShadow( pointShadowMap[ i ], pointLightShadow.shadowMapSize, pointLightShadow.shadowIntensity, pointLightShadow.shadowBias, pointLightShadow.shadowRadius, vPointShadowCoord[ i ], pointLightShadow.shadowCameraNear, pointLightShadow.shadowCameraFar ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_SPOT_LIGHTS > 0 ) && defined( RE_Direct )
	SpotLight spotLight;
	vec4 spotColor;
	vec3 spotLightCoord;
	bool inSpotLightMap;
	#if defined( USE_SHADOWMAP ) && NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHTS; i ++ ) {
		spotLight = spotLights[ i ];
		getSpotLightInfo( spotLight, geometryPosition, directLight );
		#if ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#define SPOT_LIGHT_MAP_INDEX UNROLLED_LOOP_INDEX
		#elif ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		#define SPOT_LIGHT_MAP_INDEX NUM_SPOT_LIGHT_MAPS
		#else
		#define SPOT_LIGHT_MAP_INDEX ( UNROLLED_LOOP_INDEX - NUM_SPOT_LIGHT_SHADOWS + NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS )
		#endif
		#if ( SPOT_LIGHT_MAP_INDEX < NUM_SPOT_LIGHT_MAPS )
			spotLightCoord = vSpotLightCoord[ i ].xyz / vSpotLightCoord[ i ].w;
			inSpotLightMap = all( lessThan( abs( spotLightCoord * 2. - 1. ), vec3( 1.0 ) ) );
			spotColor = texture2D( spotLightMap[ SPOT_LIGHT_MAP_INDEX ], spotLightCoord.xy );
			directLight.color = inSpotLightMap ? directLight.color * spotColor.rgb : directLight.color;
		#endif
		#undef SPOT_LIGHT_MAP_INDEX
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
		spotLightShadow = spotLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( spotShadowMap[ i ], spotLightShadow.shadowMapSize, spotLightShadow.shadowIntensity, spotLightShadow.shadowBias, spotLightShadow.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_DIR_LIGHTS > 0 ) && defined( RE_Direct )
	DirectionalLight directionalLight;
	#if defined( USE_SHADOWMAP ) && NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLightShadow;
	#endif
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHTS; i ++ ) {
		directionalLight = directionalLights[ i ];
		getDirectionalLightInfo( directionalLight, directLight );
		#if defined( USE_SHADOWMAP ) && ( UNROLLED_LOOP_INDEX < NUM_DIR_LIGHT_SHADOWS )
		directionalLightShadow = directionalLightShadows[ i ];
		directLight.color *= ( directLight.visible && receiveShadow ) ? getShadow( directionalShadowMap[ i ], directionalLightShadow.shadowMapSize, directionalLightShadow.shadowIntensity, directionalLightShadow.shadowBias, directionalLightShadow.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
		#endif
		RE_Direct( directLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if ( NUM_RECT_AREA_LIGHTS > 0 ) && defined( RE_Direct_RectArea )
	RectAreaLight rectAreaLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_RECT_AREA_LIGHTS; i ++ ) {
		rectAreaLight = rectAreaLights[ i ];
		RE_Direct_RectArea( rectAreaLight, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
	}
	#pragma unroll_loop_end
#endif
#if defined( RE_IndirectDiffuse )
	vec3 iblIrradiance = vec3( 0.0 );
	vec3 irradiance = getAmbientLightIrradiance( ambientLightColor );
	#if defined( USE_LIGHT_PROBES )
		irradiance += getLightProbeIrradiance( lightProbe, geometryNormal );
	#endif
	#if ( NUM_HEMI_LIGHTS > 0 )
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_HEMI_LIGHTS; i ++ ) {
			irradiance += getHemisphereLightIrradiance( hemisphereLights[ i ], geometryNormal );
		}
		#pragma unroll_loop_end
	#endif
#endif
#if defined( RE_IndirectSpecular )
	vec3 radiance = vec3( 0.0 );
	vec3 clearcoatRadiance = vec3( 0.0 );
#endif`,Yy=`#if defined( RE_IndirectDiffuse )
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		vec3 lightMapIrradiance = lightMapTexel.rgb * lightMapIntensity;
		irradiance += lightMapIrradiance;
	#endif
	#if defined( USE_ENVMAP ) && defined( STANDARD ) && defined( ENVMAP_TYPE_CUBE_UV )
		iblIrradiance += getIBLIrradiance( geometryNormal );
	#endif
#endif
#if defined( USE_ENVMAP ) && defined( RE_IndirectSpecular )
	#ifdef USE_ANISOTROPY
		radiance += getIBLAnisotropyRadiance( geometryViewDir, geometryNormal, material.roughness, material.anisotropyB, material.anisotropy );
	#else
		radiance += getIBLRadiance( geometryViewDir, geometryNormal, material.roughness );
	#endif
	#ifdef USE_CLEARCOAT
		clearcoatRadiance += getIBLRadiance( geometryViewDir, geometryClearcoatNormal, material.clearcoatRoughness );
	#endif
#endif`,$y=`#if defined( RE_IndirectDiffuse )
	RE_IndirectDiffuse( irradiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif
#if defined( RE_IndirectSpecular )
	RE_IndirectSpecular( radiance, iblIrradiance, clearcoatRadiance, geometryPosition, geometryNormal, geometryViewDir, geometryClearcoatNormal, material, reflectedLight );
#endif`,Zy=`#if defined( USE_LOGDEPTHBUF )
	gl_FragDepth = vIsPerspective == 0.0 ? gl_FragCoord.z : log2( vFragDepth ) * logDepthBufFC * 0.5;
#endif`,Jy=`#if defined( USE_LOGDEPTHBUF )
	uniform float logDepthBufFC;
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,Ky=`#ifdef USE_LOGDEPTHBUF
	varying float vFragDepth;
	varying float vIsPerspective;
#endif`,jy=`#ifdef USE_LOGDEPTHBUF
	vFragDepth = 1.0 + gl_Position.w;
	vIsPerspective = float( isPerspectiveMatrix( projectionMatrix ) );
#endif`,Qy=`#ifdef USE_MAP
	vec4 sampledDiffuseColor = texture2D( map, vMapUv );
	#ifdef DECODE_VIDEO_TEXTURE
		sampledDiffuseColor = sRGBTransferEOTF( sampledDiffuseColor );
	#endif
	diffuseColor *= sampledDiffuseColor;
#endif`,tv=`#ifdef USE_MAP
	uniform sampler2D map;
#endif`,ev=`#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
	#if defined( USE_POINTS_UV )
		vec2 uv = vUv;
	#else
		vec2 uv = ( uvTransform * vec3( gl_PointCoord.x, 1.0 - gl_PointCoord.y, 1 ) ).xy;
	#endif
#endif
#ifdef USE_MAP
	diffuseColor *= texture2D( map, uv );
#endif
#ifdef USE_ALPHAMAP
	diffuseColor.a *= texture2D( alphaMap, uv ).g;
#endif`,nv=`#if defined( USE_POINTS_UV )
	varying vec2 vUv;
#else
	#if defined( USE_MAP ) || defined( USE_ALPHAMAP )
		uniform mat3 uvTransform;
	#endif
#endif
#ifdef USE_MAP
	uniform sampler2D map;
#endif
#ifdef USE_ALPHAMAP
	uniform sampler2D alphaMap;
#endif`,iv=`float metalnessFactor = metalness;
#ifdef USE_METALNESSMAP
	vec4 texelMetalness = texture2D( metalnessMap, vMetalnessMapUv );
	metalnessFactor *= texelMetalness.b;
#endif`,sv=`#ifdef USE_METALNESSMAP
	uniform sampler2D metalnessMap;
#endif`,rv=`#ifdef USE_INSTANCING_MORPH
	float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	float morphTargetBaseInfluence = texelFetch( morphTexture, ivec2( 0, gl_InstanceID ), 0 ).r;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		morphTargetInfluences[i] =  texelFetch( morphTexture, ivec2( i + 1, gl_InstanceID ), 0 ).r;
	}
#endif`,ov=`#if defined( USE_MORPHCOLORS )
	vColor *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		#if defined( USE_COLOR_ALPHA )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ) * morphTargetInfluences[ i ];
		#elif defined( USE_COLOR )
			if ( morphTargetInfluences[ i ] != 0.0 ) vColor += getMorph( gl_VertexID, i, 2 ).rgb * morphTargetInfluences[ i ];
		#endif
	}
#endif`,av=`#ifdef USE_MORPHNORMALS
	objectNormal *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) objectNormal += getMorph( gl_VertexID, i, 1 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,lv=`#ifdef USE_MORPHTARGETS
	#ifndef USE_INSTANCING_MORPH
		uniform float morphTargetBaseInfluence;
		uniform float morphTargetInfluences[ MORPHTARGETS_COUNT ];
	#endif
	uniform sampler2DArray morphTargetsTexture;
	uniform ivec2 morphTargetsTextureSize;
	vec4 getMorph( const in int vertexIndex, const in int morphTargetIndex, const in int offset ) {
		int texelIndex = vertexIndex * MORPHTARGETS_TEXTURE_STRIDE + offset;
		int y = texelIndex / morphTargetsTextureSize.x;
		int x = texelIndex - y * morphTargetsTextureSize.x;
		ivec3 morphUV = ivec3( x, y, morphTargetIndex );
		return texelFetch( morphTargetsTexture, morphUV, 0 );
	}
#endif`,cv=`#ifdef USE_MORPHTARGETS
	transformed *= morphTargetBaseInfluence;
	for ( int i = 0; i < MORPHTARGETS_COUNT; i ++ ) {
		if ( morphTargetInfluences[ i ] != 0.0 ) transformed += getMorph( gl_VertexID, i, 0 ).xyz * morphTargetInfluences[ i ];
	}
#endif`,hv=`float faceDirection = gl_FrontFacing ? 1.0 : - 1.0;
#ifdef FLAT_SHADED
	vec3 fdx = dFdx( vViewPosition );
	vec3 fdy = dFdy( vViewPosition );
	vec3 normal = normalize( cross( fdx, fdy ) );
#else
	vec3 normal = normalize( vNormal );
	#ifdef DOUBLE_SIDED
		normal *= faceDirection;
	#endif
#endif
#if defined( USE_NORMALMAP_TANGENTSPACE ) || defined( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY )
	#ifdef USE_TANGENT
		mat3 tbn = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn = getTangentFrame( - vViewPosition, normal,
		#if defined( USE_NORMALMAP )
			vNormalMapUv
		#elif defined( USE_CLEARCOAT_NORMALMAP )
			vClearcoatNormalMapUv
		#else
			vUv
		#endif
		);
	#endif
	#if defined( DOUBLE_SIDED ) && ! defined( FLAT_SHADED )
		tbn[0] *= faceDirection;
		tbn[1] *= faceDirection;
	#endif
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	#ifdef USE_TANGENT
		mat3 tbn2 = mat3( normalize( vTangent ), normalize( vBitangent ), normal );
	#else
		mat3 tbn2 = getTangentFrame( - vViewPosition, normal, vClearcoatNormalMapUv );
	#endif
	#if defined( DOUBLE_SIDED ) && ! defined( FLAT_SHADED )
		tbn2[0] *= faceDirection;
		tbn2[1] *= faceDirection;
	#endif
#endif
vec3 nonPerturbedNormal = normal;`,uv=`#ifdef USE_NORMALMAP_OBJECTSPACE
	normal = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	#ifdef FLIP_SIDED
		normal = - normal;
	#endif
	#ifdef DOUBLE_SIDED
		normal = normal * faceDirection;
	#endif
	normal = normalize( normalMatrix * normal );
#elif defined( USE_NORMALMAP_TANGENTSPACE )
	vec3 mapN = texture2D( normalMap, vNormalMapUv ).xyz * 2.0 - 1.0;
	mapN.xy *= normalScale;
	normal = normalize( tbn * mapN );
#elif defined( USE_BUMPMAP )
	normal = perturbNormalArb( - vViewPosition, normal, dHdxy_fwd(), faceDirection );
#endif`,fv=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,dv=`#ifndef FLAT_SHADED
	varying vec3 vNormal;
	#ifdef USE_TANGENT
		varying vec3 vTangent;
		varying vec3 vBitangent;
	#endif
#endif`,pv=`#ifndef FLAT_SHADED
	vNormal = normalize( transformedNormal );
	#ifdef USE_TANGENT
		vTangent = normalize( transformedTangent );
		vBitangent = normalize( cross( vNormal, vTangent ) * tangent.w );
	#endif
#endif`,mv=`#ifdef USE_NORMALMAP
	uniform sampler2D normalMap;
	uniform vec2 normalScale;
#endif
#ifdef USE_NORMALMAP_OBJECTSPACE
	uniform mat3 normalMatrix;
#endif
#if ! defined ( USE_TANGENT ) && ( defined ( USE_NORMALMAP_TANGENTSPACE ) || defined ( USE_CLEARCOAT_NORMALMAP ) || defined( USE_ANISOTROPY ) )
	mat3 getTangentFrame( vec3 eye_pos, vec3 surf_norm, vec2 uv ) {
		vec3 q0 = dFdx( eye_pos.xyz );
		vec3 q1 = dFdy( eye_pos.xyz );
		vec2 st0 = dFdx( uv.st );
		vec2 st1 = dFdy( uv.st );
		vec3 N = surf_norm;
		vec3 q1perp = cross( q1, N );
		vec3 q0perp = cross( N, q0 );
		vec3 T = q1perp * st0.x + q0perp * st1.x;
		vec3 B = q1perp * st0.y + q0perp * st1.y;
		float det = max( dot( T, T ), dot( B, B ) );
		float scale = ( det == 0.0 ) ? 0.0 : inversesqrt( det );
		return mat3( T * scale, B * scale, N );
	}
#endif`,gv=`#ifdef USE_CLEARCOAT
	vec3 clearcoatNormal = nonPerturbedNormal;
#endif`,_v=`#ifdef USE_CLEARCOAT_NORMALMAP
	vec3 clearcoatMapN = texture2D( clearcoatNormalMap, vClearcoatNormalMapUv ).xyz * 2.0 - 1.0;
	clearcoatMapN.xy *= clearcoatNormalScale;
	clearcoatNormal = normalize( tbn2 * clearcoatMapN );
#endif`,xv=`#ifdef USE_CLEARCOATMAP
	uniform sampler2D clearcoatMap;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform sampler2D clearcoatNormalMap;
	uniform vec2 clearcoatNormalScale;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform sampler2D clearcoatRoughnessMap;
#endif`,yv=`#ifdef USE_IRIDESCENCEMAP
	uniform sampler2D iridescenceMap;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform sampler2D iridescenceThicknessMap;
#endif`,vv=`#ifdef OPAQUE
diffuseColor.a = 1.0;
#endif
#ifdef USE_TRANSMISSION
diffuseColor.a *= material.transmissionAlpha;
#endif
gl_FragColor = vec4( outgoingLight, diffuseColor.a );`,Mv=`vec3 packNormalToRGB( const in vec3 normal ) {
	return normalize( normal ) * 0.5 + 0.5;
}
vec3 unpackRGBToNormal( const in vec3 rgb ) {
	return 2.0 * rgb.xyz - 1.0;
}
const float PackUpscale = 256. / 255.;const float UnpackDownscale = 255. / 256.;const float ShiftRight8 = 1. / 256.;
const float Inv255 = 1. / 255.;
const vec4 PackFactors = vec4( 1.0, 256.0, 256.0 * 256.0, 256.0 * 256.0 * 256.0 );
const vec2 UnpackFactors2 = vec2( UnpackDownscale, 1.0 / PackFactors.g );
const vec3 UnpackFactors3 = vec3( UnpackDownscale / PackFactors.rg, 1.0 / PackFactors.b );
const vec4 UnpackFactors4 = vec4( UnpackDownscale / PackFactors.rgb, 1.0 / PackFactors.a );
vec4 packDepthToRGBA( const in float v ) {
	if( v <= 0.0 )
		return vec4( 0., 0., 0., 0. );
	if( v >= 1.0 )
		return vec4( 1., 1., 1., 1. );
	float vuf;
	float af = modf( v * PackFactors.a, vuf );
	float bf = modf( vuf * ShiftRight8, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec4( vuf * Inv255, gf * PackUpscale, bf * PackUpscale, af );
}
vec3 packDepthToRGB( const in float v ) {
	if( v <= 0.0 )
		return vec3( 0., 0., 0. );
	if( v >= 1.0 )
		return vec3( 1., 1., 1. );
	float vuf;
	float bf = modf( v * PackFactors.b, vuf );
	float gf = modf( vuf * ShiftRight8, vuf );
	return vec3( vuf * Inv255, gf * PackUpscale, bf );
}
vec2 packDepthToRG( const in float v ) {
	if( v <= 0.0 )
		return vec2( 0., 0. );
	if( v >= 1.0 )
		return vec2( 1., 1. );
	float vuf;
	float gf = modf( v * 256., vuf );
	return vec2( vuf * Inv255, gf );
}
float unpackRGBAToDepth( const in vec4 v ) {
	return dot( v, UnpackFactors4 );
}
float unpackRGBToDepth( const in vec3 v ) {
	return dot( v, UnpackFactors3 );
}
float unpackRGToDepth( const in vec2 v ) {
	return v.r * UnpackFactors2.r + v.g * UnpackFactors2.g;
}
vec4 pack2HalfToRGBA( const in vec2 v ) {
	vec4 r = vec4( v.x, fract( v.x * 255.0 ), v.y, fract( v.y * 255.0 ) );
	return vec4( r.x - r.y / 255.0, r.y, r.z - r.w / 255.0, r.w );
}
vec2 unpackRGBATo2Half( const in vec4 v ) {
	return vec2( v.x + ( v.y / 255.0 ), v.z + ( v.w / 255.0 ) );
}
float viewZToOrthographicDepth( const in float viewZ, const in float near, const in float far ) {
	return ( viewZ + near ) / ( near - far );
}
float orthographicDepthToViewZ( const in float depth, const in float near, const in float far ) {
	return depth * ( near - far ) - near;
}
float viewZToPerspectiveDepth( const in float viewZ, const in float near, const in float far ) {
	return ( ( near + viewZ ) * far ) / ( ( far - near ) * viewZ );
}
float perspectiveDepthToViewZ( const in float depth, const in float near, const in float far ) {
	return ( near * far ) / ( ( far - near ) * depth - far );
}`,Sv=`#ifdef PREMULTIPLIED_ALPHA
	gl_FragColor.rgb *= gl_FragColor.a;
#endif`,bv=`vec4 mvPosition = vec4( transformed, 1.0 );
#ifdef USE_BATCHING
	mvPosition = batchingMatrix * mvPosition;
#endif
#ifdef USE_INSTANCING
	mvPosition = instanceMatrix * mvPosition;
#endif
mvPosition = modelViewMatrix * mvPosition;
gl_Position = projectionMatrix * mvPosition;`,wv=`#ifdef DITHERING
	gl_FragColor.rgb = dithering( gl_FragColor.rgb );
#endif`,Ev=`#ifdef DITHERING
	vec3 dithering( vec3 color ) {
		float grid_position = rand( gl_FragCoord.xy );
		vec3 dither_shift_RGB = vec3( 0.25 / 255.0, -0.25 / 255.0, 0.25 / 255.0 );
		dither_shift_RGB = mix( 2.0 * dither_shift_RGB, -2.0 * dither_shift_RGB, grid_position );
		return color + dither_shift_RGB;
	}
#endif`,Tv=`float roughnessFactor = roughness;
#ifdef USE_ROUGHNESSMAP
	vec4 texelRoughness = texture2D( roughnessMap, vRoughnessMapUv );
	roughnessFactor *= texelRoughness.g;
#endif`,Av=`#ifdef USE_ROUGHNESSMAP
	uniform sampler2D roughnessMap;
#endif`,Cv=`#if NUM_SPOT_LIGHT_COORDS > 0
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#if NUM_SPOT_LIGHT_MAPS > 0
	uniform sampler2D spotLightMap[ NUM_SPOT_LIGHT_MAPS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform sampler2D directionalShadowMap[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		uniform sampler2D spotShadowMap[ NUM_SPOT_LIGHT_SHADOWS ];
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform sampler2D pointShadowMap[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
	float texture2DCompare( sampler2D depths, vec2 uv, float compare ) {
		return step( compare, unpackRGBAToDepth( texture2D( depths, uv ) ) );
	}
	vec2 texture2DDistribution( sampler2D shadow, vec2 uv ) {
		return unpackRGBATo2Half( texture2D( shadow, uv ) );
	}
	float VSMShadow (sampler2D shadow, vec2 uv, float compare ){
		float occlusion = 1.0;
		vec2 distribution = texture2DDistribution( shadow, uv );
		float hard_shadow = step( compare , distribution.x );
		if (hard_shadow != 1.0 ) {
			float distance = compare - distribution.x ;
			float variance = max( 0.00000, distribution.y * distribution.y );
			float softness_probability = variance / (variance + distance * distance );			softness_probability = clamp( ( softness_probability - 0.3 ) / ( 0.95 - 0.3 ), 0.0, 1.0 );			occlusion = clamp( max( hard_shadow, softness_probability ), 0.0, 1.0 );
		}
		return occlusion;
	}
	float getShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord ) {
		float shadow = 1.0;
		shadowCoord.xyz /= shadowCoord.w;
		shadowCoord.z += shadowBias;
		bool inFrustum = shadowCoord.x >= 0.0 && shadowCoord.x <= 1.0 && shadowCoord.y >= 0.0 && shadowCoord.y <= 1.0;
		bool frustumTest = inFrustum && shadowCoord.z <= 1.0;
		if ( frustumTest ) {
		#if defined( SHADOWMAP_TYPE_PCF )
			vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
			float dx0 = - texelSize.x * shadowRadius;
			float dy0 = - texelSize.y * shadowRadius;
			float dx1 = + texelSize.x * shadowRadius;
			float dy1 = + texelSize.y * shadowRadius;
			float dx2 = dx0 / 2.0;
			float dy2 = dy0 / 2.0;
			float dx3 = dx1 / 2.0;
			float dy3 = dy1 / 2.0;
			shadow = (
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx0, dy0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( 0.0, dy0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx1, dy0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx2, dy2 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( 0.0, dy2 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx3, dy2 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx0, 0.0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx2, 0.0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy, shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx3, 0.0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx1, 0.0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx2, dy3 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( 0.0, dy3 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx3, dy3 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx0, dy1 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( 0.0, dy1 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, shadowCoord.xy + vec2( dx1, dy1 ), shadowCoord.z )
			) * ( 1.0 / 17.0 );
		#elif defined( SHADOWMAP_TYPE_PCF_SOFT )
			vec2 texelSize = vec2( 1.0 ) / shadowMapSize;
			float dx = texelSize.x;
			float dy = texelSize.y;
			vec2 uv = shadowCoord.xy;
			vec2 f = fract( uv * shadowMapSize + 0.5 );
			uv -= f * texelSize;
			shadow = (
				texture2DCompare( shadowMap, uv, shadowCoord.z ) +
				texture2DCompare( shadowMap, uv + vec2( dx, 0.0 ), shadowCoord.z ) +
				texture2DCompare( shadowMap, uv + vec2( 0.0, dy ), shadowCoord.z ) +
				texture2DCompare( shadowMap, uv + texelSize, shadowCoord.z ) +
				mix( texture2DCompare( shadowMap, uv + vec2( -dx, 0.0 ), shadowCoord.z ),
					 texture2DCompare( shadowMap, uv + vec2( 2.0 * dx, 0.0 ), shadowCoord.z ),
					 f.x ) +
				mix( texture2DCompare( shadowMap, uv + vec2( -dx, dy ), shadowCoord.z ),
					 texture2DCompare( shadowMap, uv + vec2( 2.0 * dx, dy ), shadowCoord.z ),
					 f.x ) +
				mix( texture2DCompare( shadowMap, uv + vec2( 0.0, -dy ), shadowCoord.z ),
					 texture2DCompare( shadowMap, uv + vec2( 0.0, 2.0 * dy ), shadowCoord.z ),
					 f.y ) +
				mix( texture2DCompare( shadowMap, uv + vec2( dx, -dy ), shadowCoord.z ),
					 texture2DCompare( shadowMap, uv + vec2( dx, 2.0 * dy ), shadowCoord.z ),
					 f.y ) +
				mix( mix( texture2DCompare( shadowMap, uv + vec2( -dx, -dy ), shadowCoord.z ),
						  texture2DCompare( shadowMap, uv + vec2( 2.0 * dx, -dy ), shadowCoord.z ),
						  f.x ),
					 mix( texture2DCompare( shadowMap, uv + vec2( -dx, 2.0 * dy ), shadowCoord.z ),
						  texture2DCompare( shadowMap, uv + vec2( 2.0 * dx, 2.0 * dy ), shadowCoord.z ),
						  f.x ),
					 f.y )
			) * ( 1.0 / 9.0 );
		#elif defined( SHADOWMAP_TYPE_VSM )
			shadow = VSMShadow( shadowMap, shadowCoord.xy, shadowCoord.z );
		#else
			shadow = texture2DCompare( shadowMap, shadowCoord.xy, shadowCoord.z );
		#endif
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
	vec2 cubeToUV( vec3 v, float texelSizeY ) {
		vec3 absV = abs( v );
		float scaleToCube = 1.0 / max( absV.x, max( absV.y, absV.z ) );
		absV *= scaleToCube;
		v *= scaleToCube * ( 1.0 - 2.0 * texelSizeY );
		vec2 planar = v.xy;
		float almostATexel = 1.5 * texelSizeY;
		float almostOne = 1.0 - almostATexel;
		if ( absV.z >= almostOne ) {
			if ( v.z > 0.0 )
				planar.x = 4.0 - v.x;
		} else if ( absV.x >= almostOne ) {
			float signX = sign( v.x );
			planar.x = v.z * signX + 2.0 * signX;
		} else if ( absV.y >= almostOne ) {
			float signY = sign( v.y );
			planar.x = v.x + 2.0 * signY + 2.0;
			planar.y = v.z * signY - 2.0;
		}
		return vec2( 0.125, 0.25 ) * planar + vec2( 0.375, 0.75 );
	}
	float getPointShadow( sampler2D shadowMap, vec2 shadowMapSize, float shadowIntensity, float shadowBias, float shadowRadius, vec4 shadowCoord, float shadowCameraNear, float shadowCameraFar ) {
		float shadow = 1.0;
		vec3 lightToPosition = shadowCoord.xyz;
		
		float lightToPositionLength = length( lightToPosition );
		if ( lightToPositionLength - shadowCameraFar <= 0.0 && lightToPositionLength - shadowCameraNear >= 0.0 ) {
			float dp = ( lightToPositionLength - shadowCameraNear ) / ( shadowCameraFar - shadowCameraNear );			dp += shadowBias;
			vec3 bd3D = normalize( lightToPosition );
			vec2 texelSize = vec2( 1.0 ) / ( shadowMapSize * vec2( 4.0, 2.0 ) );
			#if defined( SHADOWMAP_TYPE_PCF ) || defined( SHADOWMAP_TYPE_PCF_SOFT ) || defined( SHADOWMAP_TYPE_VSM )
				vec2 offset = vec2( - 1, 1 ) * shadowRadius * texelSize.y;
				shadow = (
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.xyy, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.yyy, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.xyx, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.yyx, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.xxy, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.yxy, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.xxx, texelSize.y ), dp ) +
					texture2DCompare( shadowMap, cubeToUV( bd3D + offset.yxx, texelSize.y ), dp )
				) * ( 1.0 / 9.0 );
			#else
				shadow = texture2DCompare( shadowMap, cubeToUV( bd3D, texelSize.y ), dp );
			#endif
		}
		return mix( 1.0, shadow, shadowIntensity );
	}
#endif`,Rv=`#if NUM_SPOT_LIGHT_COORDS > 0
	uniform mat4 spotLightMatrix[ NUM_SPOT_LIGHT_COORDS ];
	varying vec4 vSpotLightCoord[ NUM_SPOT_LIGHT_COORDS ];
#endif
#ifdef USE_SHADOWMAP
	#if NUM_DIR_LIGHT_SHADOWS > 0
		uniform mat4 directionalShadowMatrix[ NUM_DIR_LIGHT_SHADOWS ];
		varying vec4 vDirectionalShadowCoord[ NUM_DIR_LIGHT_SHADOWS ];
		struct DirectionalLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform DirectionalLightShadow directionalLightShadows[ NUM_DIR_LIGHT_SHADOWS ];
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
		struct SpotLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
		};
		uniform SpotLightShadow spotLightShadows[ NUM_SPOT_LIGHT_SHADOWS ];
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		uniform mat4 pointShadowMatrix[ NUM_POINT_LIGHT_SHADOWS ];
		varying vec4 vPointShadowCoord[ NUM_POINT_LIGHT_SHADOWS ];
		struct PointLightShadow {
			float shadowIntensity;
			float shadowBias;
			float shadowNormalBias;
			float shadowRadius;
			vec2 shadowMapSize;
			float shadowCameraNear;
			float shadowCameraFar;
		};
		uniform PointLightShadow pointLightShadows[ NUM_POINT_LIGHT_SHADOWS ];
	#endif
#endif`,Pv=`#if ( defined( USE_SHADOWMAP ) && ( NUM_DIR_LIGHT_SHADOWS > 0 || NUM_POINT_LIGHT_SHADOWS > 0 ) ) || ( NUM_SPOT_LIGHT_COORDS > 0 )
	vec3 shadowWorldNormal = inverseTransformDirection( transformedNormal, viewMatrix );
	vec4 shadowWorldPosition;
#endif
#if defined( USE_SHADOWMAP )
	#if NUM_DIR_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * directionalLightShadows[ i ].shadowNormalBias, 0 );
			vDirectionalShadowCoord[ i ] = directionalShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
		#pragma unroll_loop_start
		for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
			shadowWorldPosition = worldPosition + vec4( shadowWorldNormal * pointLightShadows[ i ].shadowNormalBias, 0 );
			vPointShadowCoord[ i ] = pointShadowMatrix[ i ] * shadowWorldPosition;
		}
		#pragma unroll_loop_end
	#endif
#endif
#if NUM_SPOT_LIGHT_COORDS > 0
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_COORDS; i ++ ) {
		shadowWorldPosition = worldPosition;
		#if ( defined( USE_SHADOWMAP ) && UNROLLED_LOOP_INDEX < NUM_SPOT_LIGHT_SHADOWS )
			shadowWorldPosition.xyz += shadowWorldNormal * spotLightShadows[ i ].shadowNormalBias;
		#endif
		vSpotLightCoord[ i ] = spotLightMatrix[ i ] * shadowWorldPosition;
	}
	#pragma unroll_loop_end
#endif`,Iv=`float getShadowMask() {
	float shadow = 1.0;
	#ifdef USE_SHADOWMAP
	#if NUM_DIR_LIGHT_SHADOWS > 0
	DirectionalLightShadow directionalLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_DIR_LIGHT_SHADOWS; i ++ ) {
		directionalLight = directionalLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( directionalShadowMap[ i ], directionalLight.shadowMapSize, directionalLight.shadowIntensity, directionalLight.shadowBias, directionalLight.shadowRadius, vDirectionalShadowCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_SPOT_LIGHT_SHADOWS > 0
	SpotLightShadow spotLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_SPOT_LIGHT_SHADOWS; i ++ ) {
		spotLight = spotLightShadows[ i ];
		shadow *= receiveShadow ? getShadow( spotShadowMap[ i ], spotLight.shadowMapSize, spotLight.shadowIntensity, spotLight.shadowBias, spotLight.shadowRadius, vSpotLightCoord[ i ] ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#if NUM_POINT_LIGHT_SHADOWS > 0
	PointLightShadow pointLight;
	#pragma unroll_loop_start
	for ( int i = 0; i < NUM_POINT_LIGHT_SHADOWS; i ++ ) {
		pointLight = pointLightShadows[ i ];
		shadow *= receiveShadow ? getPointShadow( pointShadowMap[ i ], pointLight.shadowMapSize, pointLight.shadowIntensity, pointLight.shadowBias, pointLight.shadowRadius, vPointShadowCoord[ i ], pointLight.shadowCameraNear, pointLight.shadowCameraFar ) : 1.0;
	}
	#pragma unroll_loop_end
	#endif
	#endif
	return shadow;
}`,Lv=`#ifdef USE_SKINNING
	mat4 boneMatX = getBoneMatrix( skinIndex.x );
	mat4 boneMatY = getBoneMatrix( skinIndex.y );
	mat4 boneMatZ = getBoneMatrix( skinIndex.z );
	mat4 boneMatW = getBoneMatrix( skinIndex.w );
#endif`,Dv=`#ifdef USE_SKINNING
	uniform mat4 bindMatrix;
	uniform mat4 bindMatrixInverse;
	uniform highp sampler2D boneTexture;
	mat4 getBoneMatrix( const in float i ) {
		int size = textureSize( boneTexture, 0 ).x;
		int j = int( i ) * 4;
		int x = j % size;
		int y = j / size;
		vec4 v1 = texelFetch( boneTexture, ivec2( x, y ), 0 );
		vec4 v2 = texelFetch( boneTexture, ivec2( x + 1, y ), 0 );
		vec4 v3 = texelFetch( boneTexture, ivec2( x + 2, y ), 0 );
		vec4 v4 = texelFetch( boneTexture, ivec2( x + 3, y ), 0 );
		return mat4( v1, v2, v3, v4 );
	}
#endif`,Uv=`#ifdef USE_SKINNING
	vec4 skinVertex = bindMatrix * vec4( transformed, 1.0 );
	vec4 skinned = vec4( 0.0 );
	skinned += boneMatX * skinVertex * skinWeight.x;
	skinned += boneMatY * skinVertex * skinWeight.y;
	skinned += boneMatZ * skinVertex * skinWeight.z;
	skinned += boneMatW * skinVertex * skinWeight.w;
	transformed = ( bindMatrixInverse * skinned ).xyz;
#endif`,Nv=`#ifdef USE_SKINNING
	mat4 skinMatrix = mat4( 0.0 );
	skinMatrix += skinWeight.x * boneMatX;
	skinMatrix += skinWeight.y * boneMatY;
	skinMatrix += skinWeight.z * boneMatZ;
	skinMatrix += skinWeight.w * boneMatW;
	skinMatrix = bindMatrixInverse * skinMatrix * bindMatrix;
	objectNormal = vec4( skinMatrix * vec4( objectNormal, 0.0 ) ).xyz;
	#ifdef USE_TANGENT
		objectTangent = vec4( skinMatrix * vec4( objectTangent, 0.0 ) ).xyz;
	#endif
#endif`,Ov=`float specularStrength;
#ifdef USE_SPECULARMAP
	vec4 texelSpecular = texture2D( specularMap, vSpecularMapUv );
	specularStrength = texelSpecular.r;
#else
	specularStrength = 1.0;
#endif`,Fv=`#ifdef USE_SPECULARMAP
	uniform sampler2D specularMap;
#endif`,Bv=`#if defined( TONE_MAPPING )
	gl_FragColor.rgb = toneMapping( gl_FragColor.rgb );
#endif`,kv=`#ifndef saturate
#define saturate( a ) clamp( a, 0.0, 1.0 )
#endif
uniform float toneMappingExposure;
vec3 LinearToneMapping( vec3 color ) {
	return saturate( toneMappingExposure * color );
}
vec3 ReinhardToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	return saturate( color / ( vec3( 1.0 ) + color ) );
}
vec3 CineonToneMapping( vec3 color ) {
	color *= toneMappingExposure;
	color = max( vec3( 0.0 ), color - 0.004 );
	return pow( ( color * ( 6.2 * color + 0.5 ) ) / ( color * ( 6.2 * color + 1.7 ) + 0.06 ), vec3( 2.2 ) );
}
vec3 RRTAndODTFit( vec3 v ) {
	vec3 a = v * ( v + 0.0245786 ) - 0.000090537;
	vec3 b = v * ( 0.983729 * v + 0.4329510 ) + 0.238081;
	return a / b;
}
vec3 ACESFilmicToneMapping( vec3 color ) {
	const mat3 ACESInputMat = mat3(
		vec3( 0.59719, 0.07600, 0.02840 ),		vec3( 0.35458, 0.90834, 0.13383 ),
		vec3( 0.04823, 0.01566, 0.83777 )
	);
	const mat3 ACESOutputMat = mat3(
		vec3(  1.60475, -0.10208, -0.00327 ),		vec3( -0.53108,  1.10813, -0.07276 ),
		vec3( -0.07367, -0.00605,  1.07602 )
	);
	color *= toneMappingExposure / 0.6;
	color = ACESInputMat * color;
	color = RRTAndODTFit( color );
	color = ACESOutputMat * color;
	return saturate( color );
}
const mat3 LINEAR_REC2020_TO_LINEAR_SRGB = mat3(
	vec3( 1.6605, - 0.1246, - 0.0182 ),
	vec3( - 0.5876, 1.1329, - 0.1006 ),
	vec3( - 0.0728, - 0.0083, 1.1187 )
);
const mat3 LINEAR_SRGB_TO_LINEAR_REC2020 = mat3(
	vec3( 0.6274, 0.0691, 0.0164 ),
	vec3( 0.3293, 0.9195, 0.0880 ),
	vec3( 0.0433, 0.0113, 0.8956 )
);
vec3 agxDefaultContrastApprox( vec3 x ) {
	vec3 x2 = x * x;
	vec3 x4 = x2 * x2;
	return + 15.5 * x4 * x2
		- 40.14 * x4 * x
		+ 31.96 * x4
		- 6.868 * x2 * x
		+ 0.4298 * x2
		+ 0.1191 * x
		- 0.00232;
}
vec3 AgXToneMapping( vec3 color ) {
	const mat3 AgXInsetMatrix = mat3(
		vec3( 0.856627153315983, 0.137318972929847, 0.11189821299995 ),
		vec3( 0.0951212405381588, 0.761241990602591, 0.0767994186031903 ),
		vec3( 0.0482516061458583, 0.101439036467562, 0.811302368396859 )
	);
	const mat3 AgXOutsetMatrix = mat3(
		vec3( 1.1271005818144368, - 0.1413297634984383, - 0.14132976349843826 ),
		vec3( - 0.11060664309660323, 1.157823702216272, - 0.11060664309660294 ),
		vec3( - 0.016493938717834573, - 0.016493938717834257, 1.2519364065950405 )
	);
	const float AgxMinEv = - 12.47393;	const float AgxMaxEv = 4.026069;
	color *= toneMappingExposure;
	color = LINEAR_SRGB_TO_LINEAR_REC2020 * color;
	color = AgXInsetMatrix * color;
	color = max( color, 1e-10 );	color = log2( color );
	color = ( color - AgxMinEv ) / ( AgxMaxEv - AgxMinEv );
	color = clamp( color, 0.0, 1.0 );
	color = agxDefaultContrastApprox( color );
	color = AgXOutsetMatrix * color;
	color = pow( max( vec3( 0.0 ), color ), vec3( 2.2 ) );
	color = LINEAR_REC2020_TO_LINEAR_SRGB * color;
	color = clamp( color, 0.0, 1.0 );
	return color;
}
vec3 NeutralToneMapping( vec3 color ) {
	const float StartCompression = 0.8 - 0.04;
	const float Desaturation = 0.15;
	color *= toneMappingExposure;
	float x = min( color.r, min( color.g, color.b ) );
	float offset = x < 0.08 ? x - 6.25 * x * x : 0.04;
	color -= offset;
	float peak = max( color.r, max( color.g, color.b ) );
	if ( peak < StartCompression ) return color;
	float d = 1. - StartCompression;
	float newPeak = 1. - d * d / ( peak + d - StartCompression );
	color *= newPeak / peak;
	float g = 1. - 1. / ( Desaturation * ( peak - newPeak ) + 1. );
	return mix( color, vec3( newPeak ), g );
}
vec3 CustomToneMapping( vec3 color ) { return color; }`,zv=`#ifdef USE_TRANSMISSION
	material.transmission = transmission;
	material.transmissionAlpha = 1.0;
	material.thickness = thickness;
	material.attenuationDistance = attenuationDistance;
	material.attenuationColor = attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		material.transmission *= texture2D( transmissionMap, vTransmissionMapUv ).r;
	#endif
	#ifdef USE_THICKNESSMAP
		material.thickness *= texture2D( thicknessMap, vThicknessMapUv ).g;
	#endif
	vec3 pos = vWorldPosition;
	vec3 v = normalize( cameraPosition - pos );
	vec3 n = inverseTransformDirection( normal, viewMatrix );
	vec4 transmitted = getIBLVolumeRefraction(
		n, v, material.roughness, material.diffuseColor, material.specularColor, material.specularF90,
		pos, modelMatrix, viewMatrix, projectionMatrix, material.dispersion, material.ior, material.thickness,
		material.attenuationColor, material.attenuationDistance );
	material.transmissionAlpha = mix( material.transmissionAlpha, transmitted.a, material.transmission );
	totalDiffuse = mix( totalDiffuse, transmitted.rgb, material.transmission );
#endif`,Vv=`#ifdef USE_TRANSMISSION
	uniform float transmission;
	uniform float thickness;
	uniform float attenuationDistance;
	uniform vec3 attenuationColor;
	#ifdef USE_TRANSMISSIONMAP
		uniform sampler2D transmissionMap;
	#endif
	#ifdef USE_THICKNESSMAP
		uniform sampler2D thicknessMap;
	#endif
	uniform vec2 transmissionSamplerSize;
	uniform sampler2D transmissionSamplerMap;
	uniform mat4 modelMatrix;
	uniform mat4 projectionMatrix;
	varying vec3 vWorldPosition;
	float w0( float a ) {
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - a + 3.0 ) - 3.0 ) + 1.0 );
	}
	float w1( float a ) {
		return ( 1.0 / 6.0 ) * ( a *  a * ( 3.0 * a - 6.0 ) + 4.0 );
	}
	float w2( float a ){
		return ( 1.0 / 6.0 ) * ( a * ( a * ( - 3.0 * a + 3.0 ) + 3.0 ) + 1.0 );
	}
	float w3( float a ) {
		return ( 1.0 / 6.0 ) * ( a * a * a );
	}
	float g0( float a ) {
		return w0( a ) + w1( a );
	}
	float g1( float a ) {
		return w2( a ) + w3( a );
	}
	float h0( float a ) {
		return - 1.0 + w1( a ) / ( w0( a ) + w1( a ) );
	}
	float h1( float a ) {
		return 1.0 + w3( a ) / ( w2( a ) + w3( a ) );
	}
	vec4 bicubic( sampler2D tex, vec2 uv, vec4 texelSize, float lod ) {
		uv = uv * texelSize.zw + 0.5;
		vec2 iuv = floor( uv );
		vec2 fuv = fract( uv );
		float g0x = g0( fuv.x );
		float g1x = g1( fuv.x );
		float h0x = h0( fuv.x );
		float h1x = h1( fuv.x );
		float h0y = h0( fuv.y );
		float h1y = h1( fuv.y );
		vec2 p0 = ( vec2( iuv.x + h0x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p1 = ( vec2( iuv.x + h1x, iuv.y + h0y ) - 0.5 ) * texelSize.xy;
		vec2 p2 = ( vec2( iuv.x + h0x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		vec2 p3 = ( vec2( iuv.x + h1x, iuv.y + h1y ) - 0.5 ) * texelSize.xy;
		return g0( fuv.y ) * ( g0x * textureLod( tex, p0, lod ) + g1x * textureLod( tex, p1, lod ) ) +
			g1( fuv.y ) * ( g0x * textureLod( tex, p2, lod ) + g1x * textureLod( tex, p3, lod ) );
	}
	vec4 textureBicubic( sampler2D sampler, vec2 uv, float lod ) {
		vec2 fLodSize = vec2( textureSize( sampler, int( lod ) ) );
		vec2 cLodSize = vec2( textureSize( sampler, int( lod + 1.0 ) ) );
		vec2 fLodSizeInv = 1.0 / fLodSize;
		vec2 cLodSizeInv = 1.0 / cLodSize;
		vec4 fSample = bicubic( sampler, uv, vec4( fLodSizeInv, fLodSize ), floor( lod ) );
		vec4 cSample = bicubic( sampler, uv, vec4( cLodSizeInv, cLodSize ), ceil( lod ) );
		return mix( fSample, cSample, fract( lod ) );
	}
	vec3 getVolumeTransmissionRay( const in vec3 n, const in vec3 v, const in float thickness, const in float ior, const in mat4 modelMatrix ) {
		vec3 refractionVector = refract( - v, normalize( n ), 1.0 / ior );
		vec3 modelScale;
		modelScale.x = length( vec3( modelMatrix[ 0 ].xyz ) );
		modelScale.y = length( vec3( modelMatrix[ 1 ].xyz ) );
		modelScale.z = length( vec3( modelMatrix[ 2 ].xyz ) );
		return normalize( refractionVector ) * thickness * modelScale;
	}
	float applyIorToRoughness( const in float roughness, const in float ior ) {
		return roughness * clamp( ior * 2.0 - 2.0, 0.0, 1.0 );
	}
	vec4 getTransmissionSample( const in vec2 fragCoord, const in float roughness, const in float ior ) {
		float lod = log2( transmissionSamplerSize.x ) * applyIorToRoughness( roughness, ior );
		return textureBicubic( transmissionSamplerMap, fragCoord.xy, lod );
	}
	vec3 volumeAttenuation( const in float transmissionDistance, const in vec3 attenuationColor, const in float attenuationDistance ) {
		if ( isinf( attenuationDistance ) ) {
			return vec3( 1.0 );
		} else {
			vec3 attenuationCoefficient = -log( attenuationColor ) / attenuationDistance;
			vec3 transmittance = exp( - attenuationCoefficient * transmissionDistance );			return transmittance;
		}
	}
	vec4 getIBLVolumeRefraction( const in vec3 n, const in vec3 v, const in float roughness, const in vec3 diffuseColor,
		const in vec3 specularColor, const in float specularF90, const in vec3 position, const in mat4 modelMatrix,
		const in mat4 viewMatrix, const in mat4 projMatrix, const in float dispersion, const in float ior, const in float thickness,
		const in vec3 attenuationColor, const in float attenuationDistance ) {
		vec4 transmittedLight;
		vec3 transmittance;
		#ifdef USE_DISPERSION
			float halfSpread = ( ior - 1.0 ) * 0.025 * dispersion;
			vec3 iors = vec3( ior - halfSpread, ior, ior + halfSpread );
			for ( int i = 0; i < 3; i ++ ) {
				vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, iors[ i ], modelMatrix );
				vec3 refractedRayExit = position + transmissionRay;
		
				vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
				vec2 refractionCoords = ndcPos.xy / ndcPos.w;
				refractionCoords += 1.0;
				refractionCoords /= 2.0;
		
				vec4 transmissionSample = getTransmissionSample( refractionCoords, roughness, iors[ i ] );
				transmittedLight[ i ] = transmissionSample[ i ];
				transmittedLight.a += transmissionSample.a;
				transmittance[ i ] = diffuseColor[ i ] * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance )[ i ];
			}
			transmittedLight.a /= 3.0;
		
		#else
		
			vec3 transmissionRay = getVolumeTransmissionRay( n, v, thickness, ior, modelMatrix );
			vec3 refractedRayExit = position + transmissionRay;
			vec4 ndcPos = projMatrix * viewMatrix * vec4( refractedRayExit, 1.0 );
			vec2 refractionCoords = ndcPos.xy / ndcPos.w;
			refractionCoords += 1.0;
			refractionCoords /= 2.0;
			transmittedLight = getTransmissionSample( refractionCoords, roughness, ior );
			transmittance = diffuseColor * volumeAttenuation( length( transmissionRay ), attenuationColor, attenuationDistance );
		
		#endif
		vec3 attenuatedColor = transmittance * transmittedLight.rgb;
		vec3 F = EnvironmentBRDF( n, v, specularColor, specularF90, roughness );
		float transmittanceFactor = ( transmittance.r + transmittance.g + transmittance.b ) / 3.0;
		return vec4( ( 1.0 - F ) * attenuatedColor, 1.0 - ( 1.0 - transmittedLight.a ) * transmittanceFactor );
	}
#endif`,Hv=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_SPECULARMAP
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,Gv=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	varying vec2 vUv;
#endif
#ifdef USE_MAP
	uniform mat3 mapTransform;
	varying vec2 vMapUv;
#endif
#ifdef USE_ALPHAMAP
	uniform mat3 alphaMapTransform;
	varying vec2 vAlphaMapUv;
#endif
#ifdef USE_LIGHTMAP
	uniform mat3 lightMapTransform;
	varying vec2 vLightMapUv;
#endif
#ifdef USE_AOMAP
	uniform mat3 aoMapTransform;
	varying vec2 vAoMapUv;
#endif
#ifdef USE_BUMPMAP
	uniform mat3 bumpMapTransform;
	varying vec2 vBumpMapUv;
#endif
#ifdef USE_NORMALMAP
	uniform mat3 normalMapTransform;
	varying vec2 vNormalMapUv;
#endif
#ifdef USE_DISPLACEMENTMAP
	uniform mat3 displacementMapTransform;
	varying vec2 vDisplacementMapUv;
#endif
#ifdef USE_EMISSIVEMAP
	uniform mat3 emissiveMapTransform;
	varying vec2 vEmissiveMapUv;
#endif
#ifdef USE_METALNESSMAP
	uniform mat3 metalnessMapTransform;
	varying vec2 vMetalnessMapUv;
#endif
#ifdef USE_ROUGHNESSMAP
	uniform mat3 roughnessMapTransform;
	varying vec2 vRoughnessMapUv;
#endif
#ifdef USE_ANISOTROPYMAP
	uniform mat3 anisotropyMapTransform;
	varying vec2 vAnisotropyMapUv;
#endif
#ifdef USE_CLEARCOATMAP
	uniform mat3 clearcoatMapTransform;
	varying vec2 vClearcoatMapUv;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	uniform mat3 clearcoatNormalMapTransform;
	varying vec2 vClearcoatNormalMapUv;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	uniform mat3 clearcoatRoughnessMapTransform;
	varying vec2 vClearcoatRoughnessMapUv;
#endif
#ifdef USE_SHEEN_COLORMAP
	uniform mat3 sheenColorMapTransform;
	varying vec2 vSheenColorMapUv;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	uniform mat3 sheenRoughnessMapTransform;
	varying vec2 vSheenRoughnessMapUv;
#endif
#ifdef USE_IRIDESCENCEMAP
	uniform mat3 iridescenceMapTransform;
	varying vec2 vIridescenceMapUv;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	uniform mat3 iridescenceThicknessMapTransform;
	varying vec2 vIridescenceThicknessMapUv;
#endif
#ifdef USE_SPECULARMAP
	uniform mat3 specularMapTransform;
	varying vec2 vSpecularMapUv;
#endif
#ifdef USE_SPECULAR_COLORMAP
	uniform mat3 specularColorMapTransform;
	varying vec2 vSpecularColorMapUv;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	uniform mat3 specularIntensityMapTransform;
	varying vec2 vSpecularIntensityMapUv;
#endif
#ifdef USE_TRANSMISSIONMAP
	uniform mat3 transmissionMapTransform;
	varying vec2 vTransmissionMapUv;
#endif
#ifdef USE_THICKNESSMAP
	uniform mat3 thicknessMapTransform;
	varying vec2 vThicknessMapUv;
#endif`,Wv=`#if defined( USE_UV ) || defined( USE_ANISOTROPY )
	vUv = vec3( uv, 1 ).xy;
#endif
#ifdef USE_MAP
	vMapUv = ( mapTransform * vec3( MAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ALPHAMAP
	vAlphaMapUv = ( alphaMapTransform * vec3( ALPHAMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_LIGHTMAP
	vLightMapUv = ( lightMapTransform * vec3( LIGHTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_AOMAP
	vAoMapUv = ( aoMapTransform * vec3( AOMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_BUMPMAP
	vBumpMapUv = ( bumpMapTransform * vec3( BUMPMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_NORMALMAP
	vNormalMapUv = ( normalMapTransform * vec3( NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_DISPLACEMENTMAP
	vDisplacementMapUv = ( displacementMapTransform * vec3( DISPLACEMENTMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_EMISSIVEMAP
	vEmissiveMapUv = ( emissiveMapTransform * vec3( EMISSIVEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_METALNESSMAP
	vMetalnessMapUv = ( metalnessMapTransform * vec3( METALNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ROUGHNESSMAP
	vRoughnessMapUv = ( roughnessMapTransform * vec3( ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_ANISOTROPYMAP
	vAnisotropyMapUv = ( anisotropyMapTransform * vec3( ANISOTROPYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOATMAP
	vClearcoatMapUv = ( clearcoatMapTransform * vec3( CLEARCOATMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_NORMALMAP
	vClearcoatNormalMapUv = ( clearcoatNormalMapTransform * vec3( CLEARCOAT_NORMALMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_CLEARCOAT_ROUGHNESSMAP
	vClearcoatRoughnessMapUv = ( clearcoatRoughnessMapTransform * vec3( CLEARCOAT_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCEMAP
	vIridescenceMapUv = ( iridescenceMapTransform * vec3( IRIDESCENCEMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_IRIDESCENCE_THICKNESSMAP
	vIridescenceThicknessMapUv = ( iridescenceThicknessMapTransform * vec3( IRIDESCENCE_THICKNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_COLORMAP
	vSheenColorMapUv = ( sheenColorMapTransform * vec3( SHEEN_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SHEEN_ROUGHNESSMAP
	vSheenRoughnessMapUv = ( sheenRoughnessMapTransform * vec3( SHEEN_ROUGHNESSMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULARMAP
	vSpecularMapUv = ( specularMapTransform * vec3( SPECULARMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_COLORMAP
	vSpecularColorMapUv = ( specularColorMapTransform * vec3( SPECULAR_COLORMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_SPECULAR_INTENSITYMAP
	vSpecularIntensityMapUv = ( specularIntensityMapTransform * vec3( SPECULAR_INTENSITYMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_TRANSMISSIONMAP
	vTransmissionMapUv = ( transmissionMapTransform * vec3( TRANSMISSIONMAP_UV, 1 ) ).xy;
#endif
#ifdef USE_THICKNESSMAP
	vThicknessMapUv = ( thicknessMapTransform * vec3( THICKNESSMAP_UV, 1 ) ).xy;
#endif`,Xv=`#if defined( USE_ENVMAP ) || defined( DISTANCE ) || defined ( USE_SHADOWMAP ) || defined ( USE_TRANSMISSION ) || NUM_SPOT_LIGHT_COORDS > 0
	vec4 worldPosition = vec4( transformed, 1.0 );
	#ifdef USE_BATCHING
		worldPosition = batchingMatrix * worldPosition;
	#endif
	#ifdef USE_INSTANCING
		worldPosition = instanceMatrix * worldPosition;
	#endif
	worldPosition = modelMatrix * worldPosition;
#endif`,qv=`varying vec2 vUv;
uniform mat3 uvTransform;
void main() {
	vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	gl_Position = vec4( position.xy, 1.0, 1.0 );
}`,Yv=`uniform sampler2D t2D;
uniform float backgroundIntensity;
varying vec2 vUv;
void main() {
	vec4 texColor = texture2D( t2D, vUv );
	#ifdef DECODE_VIDEO_TEXTURE
		texColor = vec4( mix( pow( texColor.rgb * 0.9478672986 + vec3( 0.0521327014 ), vec3( 2.4 ) ), texColor.rgb * 0.0773993808, vec3( lessThanEqual( texColor.rgb, vec3( 0.04045 ) ) ) ), texColor.w );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,$v=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,Zv=`#ifdef ENVMAP_TYPE_CUBE
	uniform samplerCube envMap;
#elif defined( ENVMAP_TYPE_CUBE_UV )
	uniform sampler2D envMap;
#endif
uniform float flipEnvMap;
uniform float backgroundBlurriness;
uniform float backgroundIntensity;
uniform mat3 backgroundRotation;
varying vec3 vWorldDirection;
#include <cube_uv_reflection_fragment>
void main() {
	#ifdef ENVMAP_TYPE_CUBE
		vec4 texColor = textureCube( envMap, backgroundRotation * vec3( flipEnvMap * vWorldDirection.x, vWorldDirection.yz ) );
	#elif defined( ENVMAP_TYPE_CUBE_UV )
		vec4 texColor = textureCubeUV( envMap, backgroundRotation * vWorldDirection, backgroundBlurriness );
	#else
		vec4 texColor = vec4( 0.0, 0.0, 0.0, 1.0 );
	#endif
	texColor.rgb *= backgroundIntensity;
	gl_FragColor = texColor;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,Jv=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
	gl_Position.z = gl_Position.w;
}`,Kv=`uniform samplerCube tCube;
uniform float tFlip;
uniform float opacity;
varying vec3 vWorldDirection;
void main() {
	vec4 texColor = textureCube( tCube, vec3( tFlip * vWorldDirection.x, vWorldDirection.yz ) );
	gl_FragColor = texColor;
	gl_FragColor.a *= opacity;
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,jv=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
varying vec2 vHighPrecisionZW;
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vHighPrecisionZW = gl_Position.zw;
}`,Qv=`#if DEPTH_PACKING == 3200
	uniform float opacity;
#endif
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
varying vec2 vHighPrecisionZW;
void main() {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#if DEPTH_PACKING == 3200
		diffuseColor.a = opacity;
	#endif
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <logdepthbuf_fragment>
	float fragCoordZ = 0.5 * vHighPrecisionZW[0] / vHighPrecisionZW[1] + 0.5;
	#if DEPTH_PACKING == 3200
		gl_FragColor = vec4( vec3( 1.0 - fragCoordZ ), opacity );
	#elif DEPTH_PACKING == 3201
		gl_FragColor = packDepthToRGBA( fragCoordZ );
	#elif DEPTH_PACKING == 3202
		gl_FragColor = vec4( packDepthToRGB( fragCoordZ ), 1.0 );
	#elif DEPTH_PACKING == 3203
		gl_FragColor = vec4( packDepthToRG( fragCoordZ ), 0.0, 1.0 );
	#endif
}`,tM=`#define DISTANCE
varying vec3 vWorldPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <skinbase_vertex>
	#include <morphinstance_vertex>
	#ifdef USE_DISPLACEMENTMAP
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <worldpos_vertex>
	#include <clipping_planes_vertex>
	vWorldPosition = worldPosition.xyz;
}`,eM=`#define DISTANCE
uniform vec3 referencePosition;
uniform float nearDistance;
uniform float farDistance;
varying vec3 vWorldPosition;
#include <common>
#include <packing>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <clipping_planes_pars_fragment>
void main () {
	vec4 diffuseColor = vec4( 1.0 );
	#include <clipping_planes_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	float dist = length( vWorldPosition - referencePosition );
	dist = ( dist - nearDistance ) / ( farDistance - nearDistance );
	dist = saturate( dist );
	gl_FragColor = packDepthToRGBA( dist );
}`,nM=`varying vec3 vWorldDirection;
#include <common>
void main() {
	vWorldDirection = transformDirection( position, modelMatrix );
	#include <begin_vertex>
	#include <project_vertex>
}`,iM=`uniform sampler2D tEquirect;
varying vec3 vWorldDirection;
#include <common>
void main() {
	vec3 direction = normalize( vWorldDirection );
	vec2 sampleUV = equirectUv( direction );
	gl_FragColor = texture2D( tEquirect, sampleUV );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
}`,sM=`uniform float scale;
attribute float lineDistance;
varying float vLineDistance;
#include <common>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	vLineDistance = scale * lineDistance;
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,rM=`uniform vec3 diffuse;
uniform float opacity;
uniform float dashSize;
uniform float totalSize;
varying float vLineDistance;
#include <common>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	if ( mod( vLineDistance, totalSize ) > dashSize ) {
		discard;
	}
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,oM=`#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#if defined ( USE_ENVMAP ) || defined ( USE_SKINNING )
		#include <beginnormal_vertex>
		#include <morphnormal_vertex>
		#include <skinbase_vertex>
		#include <skinnormal_vertex>
		#include <defaultnormal_vertex>
	#endif
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <fog_vertex>
}`,aM=`uniform vec3 diffuse;
uniform float opacity;
#ifndef FLAT_SHADED
	varying vec3 vNormal;
#endif
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	#ifdef USE_LIGHTMAP
		vec4 lightMapTexel = texture2D( lightMap, vLightMapUv );
		reflectedLight.indirectDiffuse += lightMapTexel.rgb * lightMapIntensity * RECIPROCAL_PI;
	#else
		reflectedLight.indirectDiffuse += vec3( 1.0 );
	#endif
	#include <aomap_fragment>
	reflectedLight.indirectDiffuse *= diffuseColor.rgb;
	vec3 outgoingLight = reflectedLight.indirectDiffuse;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,lM=`#define LAMBERT
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,cM=`#define LAMBERT
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <packing>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_lambert_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_lambert_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,hM=`#define MATCAP
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <color_pars_vertex>
#include <displacementmap_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
	vViewPosition = - mvPosition.xyz;
}`,uM=`#define MATCAP
uniform vec3 diffuse;
uniform float opacity;
uniform sampler2D matcap;
varying vec3 vViewPosition;
#include <common>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	vec3 viewDir = normalize( vViewPosition );
	vec3 x = normalize( vec3( viewDir.z, 0.0, - viewDir.x ) );
	vec3 y = cross( viewDir, x );
	vec2 uv = vec2( dot( x, normal ), dot( y, normal ) ) * 0.495 + 0.5;
	#ifdef USE_MATCAP
		vec4 matcapColor = texture2D( matcap, uv );
	#else
		vec4 matcapColor = vec4( vec3( mix( 0.2, 0.8, uv.y ) ), 1.0 );
	#endif
	vec3 outgoingLight = diffuseColor.rgb * matcapColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,fM=`#define NORMAL
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	vViewPosition = - mvPosition.xyz;
#endif
}`,dM=`#define NORMAL
uniform float opacity;
#if defined( FLAT_SHADED ) || defined( USE_BUMPMAP ) || defined( USE_NORMALMAP_TANGENTSPACE )
	varying vec3 vViewPosition;
#endif
#include <packing>
#include <uv_pars_fragment>
#include <normal_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( 0.0, 0.0, 0.0, opacity );
	#include <clipping_planes_fragment>
	#include <logdepthbuf_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	gl_FragColor = vec4( packNormalToRGB( normal ), diffuseColor.a );
	#ifdef OPAQUE
		gl_FragColor.a = 1.0;
	#endif
}`,pM=`#define PHONG
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <envmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <envmap_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,mM=`#define PHONG
uniform vec3 diffuse;
uniform vec3 emissive;
uniform vec3 specular;
uniform float shininess;
uniform float opacity;
#include <common>
#include <packing>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_phong_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <specularmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <specularmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_phong_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + reflectedLight.directSpecular + reflectedLight.indirectSpecular + totalEmissiveRadiance;
	#include <envmap_fragment>
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,gM=`#define STANDARD
varying vec3 vViewPosition;
#ifdef USE_TRANSMISSION
	varying vec3 vWorldPosition;
#endif
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
#ifdef USE_TRANSMISSION
	vWorldPosition = worldPosition.xyz;
#endif
}`,_M=`#define STANDARD
#ifdef PHYSICAL
	#define IOR
	#define USE_SPECULAR
#endif
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float roughness;
uniform float metalness;
uniform float opacity;
#ifdef IOR
	uniform float ior;
#endif
#ifdef USE_SPECULAR
	uniform float specularIntensity;
	uniform vec3 specularColor;
	#ifdef USE_SPECULAR_COLORMAP
		uniform sampler2D specularColorMap;
	#endif
	#ifdef USE_SPECULAR_INTENSITYMAP
		uniform sampler2D specularIntensityMap;
	#endif
#endif
#ifdef USE_CLEARCOAT
	uniform float clearcoat;
	uniform float clearcoatRoughness;
#endif
#ifdef USE_DISPERSION
	uniform float dispersion;
#endif
#ifdef USE_IRIDESCENCE
	uniform float iridescence;
	uniform float iridescenceIOR;
	uniform float iridescenceThicknessMinimum;
	uniform float iridescenceThicknessMaximum;
#endif
#ifdef USE_SHEEN
	uniform vec3 sheenColor;
	uniform float sheenRoughness;
	#ifdef USE_SHEEN_COLORMAP
		uniform sampler2D sheenColorMap;
	#endif
	#ifdef USE_SHEEN_ROUGHNESSMAP
		uniform sampler2D sheenRoughnessMap;
	#endif
#endif
#ifdef USE_ANISOTROPY
	uniform vec2 anisotropyVector;
	#ifdef USE_ANISOTROPYMAP
		uniform sampler2D anisotropyMap;
	#endif
#endif
varying vec3 vViewPosition;
#include <common>
#include <packing>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <iridescence_fragment>
#include <cube_uv_reflection_fragment>
#include <envmap_common_pars_fragment>
#include <envmap_physical_pars_fragment>
#include <fog_pars_fragment>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_physical_pars_fragment>
#include <transmission_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <clearcoat_pars_fragment>
#include <iridescence_pars_fragment>
#include <roughnessmap_pars_fragment>
#include <metalnessmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <roughnessmap_fragment>
	#include <metalnessmap_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <clearcoat_normal_fragment_begin>
	#include <clearcoat_normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_physical_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 totalDiffuse = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse;
	vec3 totalSpecular = reflectedLight.directSpecular + reflectedLight.indirectSpecular;
	#include <transmission_fragment>
	vec3 outgoingLight = totalDiffuse + totalSpecular + totalEmissiveRadiance;
	#ifdef USE_SHEEN
		float sheenEnergyComp = 1.0 - 0.157 * max3( material.sheenColor );
		outgoingLight = outgoingLight * sheenEnergyComp + sheenSpecularDirect + sheenSpecularIndirect;
	#endif
	#ifdef USE_CLEARCOAT
		float dotNVcc = saturate( dot( geometryClearcoatNormal, geometryViewDir ) );
		vec3 Fcc = F_Schlick( material.clearcoatF0, material.clearcoatF90, dotNVcc );
		outgoingLight = outgoingLight * ( 1.0 - material.clearcoat * Fcc ) + ( clearcoatSpecularDirect + clearcoatSpecularIndirect ) * material.clearcoat;
	#endif
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,xM=`#define TOON
varying vec3 vViewPosition;
#include <common>
#include <batching_pars_vertex>
#include <uv_pars_vertex>
#include <displacementmap_pars_vertex>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <normal_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <shadowmap_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <normal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <displacementmap_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	vViewPosition = - mvPosition.xyz;
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,yM=`#define TOON
uniform vec3 diffuse;
uniform vec3 emissive;
uniform float opacity;
#include <common>
#include <packing>
#include <dithering_pars_fragment>
#include <color_pars_fragment>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <aomap_pars_fragment>
#include <lightmap_pars_fragment>
#include <emissivemap_pars_fragment>
#include <gradientmap_pars_fragment>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <normal_pars_fragment>
#include <lights_toon_pars_fragment>
#include <shadowmap_pars_fragment>
#include <bumpmap_pars_fragment>
#include <normalmap_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	ReflectedLight reflectedLight = ReflectedLight( vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ), vec3( 0.0 ) );
	vec3 totalEmissiveRadiance = emissive;
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <color_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	#include <normal_fragment_begin>
	#include <normal_fragment_maps>
	#include <emissivemap_fragment>
	#include <lights_toon_fragment>
	#include <lights_fragment_begin>
	#include <lights_fragment_maps>
	#include <lights_fragment_end>
	#include <aomap_fragment>
	vec3 outgoingLight = reflectedLight.directDiffuse + reflectedLight.indirectDiffuse + totalEmissiveRadiance;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
	#include <dithering_fragment>
}`,vM=`uniform float size;
uniform float scale;
#include <common>
#include <color_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
#ifdef USE_POINTS_UV
	varying vec2 vUv;
	uniform mat3 uvTransform;
#endif
void main() {
	#ifdef USE_POINTS_UV
		vUv = ( uvTransform * vec3( uv, 1 ) ).xy;
	#endif
	#include <color_vertex>
	#include <morphinstance_vertex>
	#include <morphcolor_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <project_vertex>
	gl_PointSize = size;
	#ifdef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) gl_PointSize *= ( scale / - mvPosition.z );
	#endif
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <worldpos_vertex>
	#include <fog_vertex>
}`,MM=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <color_pars_fragment>
#include <map_particle_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_particle_fragment>
	#include <color_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
	#include <premultiplied_alpha_fragment>
}`,SM=`#include <common>
#include <batching_pars_vertex>
#include <fog_pars_vertex>
#include <morphtarget_pars_vertex>
#include <skinning_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <shadowmap_pars_vertex>
void main() {
	#include <batching_vertex>
	#include <beginnormal_vertex>
	#include <morphinstance_vertex>
	#include <morphnormal_vertex>
	#include <skinbase_vertex>
	#include <skinnormal_vertex>
	#include <defaultnormal_vertex>
	#include <begin_vertex>
	#include <morphtarget_vertex>
	#include <skinning_vertex>
	#include <project_vertex>
	#include <logdepthbuf_vertex>
	#include <worldpos_vertex>
	#include <shadowmap_vertex>
	#include <fog_vertex>
}`,bM=`uniform vec3 color;
uniform float opacity;
#include <common>
#include <packing>
#include <fog_pars_fragment>
#include <bsdfs>
#include <lights_pars_begin>
#include <logdepthbuf_pars_fragment>
#include <shadowmap_pars_fragment>
#include <shadowmask_pars_fragment>
void main() {
	#include <logdepthbuf_fragment>
	gl_FragColor = vec4( color, opacity * ( 1.0 - getShadowMask() ) );
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,wM=`uniform float rotation;
uniform vec2 center;
#include <common>
#include <uv_pars_vertex>
#include <fog_pars_vertex>
#include <logdepthbuf_pars_vertex>
#include <clipping_planes_pars_vertex>
void main() {
	#include <uv_vertex>
	vec4 mvPosition = modelViewMatrix[ 3 ];
	vec2 scale = vec2( length( modelMatrix[ 0 ].xyz ), length( modelMatrix[ 1 ].xyz ) );
	#ifndef USE_SIZEATTENUATION
		bool isPerspective = isPerspectiveMatrix( projectionMatrix );
		if ( isPerspective ) scale *= - mvPosition.z;
	#endif
	vec2 alignedPosition = ( position.xy - ( center - vec2( 0.5 ) ) ) * scale;
	vec2 rotatedPosition;
	rotatedPosition.x = cos( rotation ) * alignedPosition.x - sin( rotation ) * alignedPosition.y;
	rotatedPosition.y = sin( rotation ) * alignedPosition.x + cos( rotation ) * alignedPosition.y;
	mvPosition.xy += rotatedPosition;
	gl_Position = projectionMatrix * mvPosition;
	#include <logdepthbuf_vertex>
	#include <clipping_planes_vertex>
	#include <fog_vertex>
}`,EM=`uniform vec3 diffuse;
uniform float opacity;
#include <common>
#include <uv_pars_fragment>
#include <map_pars_fragment>
#include <alphamap_pars_fragment>
#include <alphatest_pars_fragment>
#include <alphahash_pars_fragment>
#include <fog_pars_fragment>
#include <logdepthbuf_pars_fragment>
#include <clipping_planes_pars_fragment>
void main() {
	vec4 diffuseColor = vec4( diffuse, opacity );
	#include <clipping_planes_fragment>
	vec3 outgoingLight = vec3( 0.0 );
	#include <logdepthbuf_fragment>
	#include <map_fragment>
	#include <alphamap_fragment>
	#include <alphatest_fragment>
	#include <alphahash_fragment>
	outgoingLight = diffuseColor.rgb;
	#include <opaque_fragment>
	#include <tonemapping_fragment>
	#include <colorspace_fragment>
	#include <fog_fragment>
}`,ae={alphahash_fragment:Yx,alphahash_pars_fragment:$x,alphamap_fragment:Zx,alphamap_pars_fragment:Jx,alphatest_fragment:Kx,alphatest_pars_fragment:jx,aomap_fragment:Qx,aomap_pars_fragment:ty,batching_pars_vertex:ey,batching_vertex:ny,begin_vertex:iy,beginnormal_vertex:sy,bsdfs:ry,iridescence_fragment:oy,bumpmap_pars_fragment:ay,clipping_planes_fragment:ly,clipping_planes_pars_fragment:cy,clipping_planes_pars_vertex:hy,clipping_planes_vertex:uy,color_fragment:fy,color_pars_fragment:dy,color_pars_vertex:py,color_vertex:my,common:gy,cube_uv_reflection_fragment:_y,defaultnormal_vertex:xy,displacementmap_pars_vertex:yy,displacementmap_vertex:vy,emissivemap_fragment:My,emissivemap_pars_fragment:Sy,colorspace_fragment:by,colorspace_pars_fragment:wy,envmap_fragment:Ey,envmap_common_pars_fragment:Ty,envmap_pars_fragment:Ay,envmap_pars_vertex:Cy,envmap_physical_pars_fragment:ky,envmap_vertex:Ry,fog_vertex:Py,fog_pars_vertex:Iy,fog_fragment:Ly,fog_pars_fragment:Dy,gradientmap_pars_fragment:Uy,lightmap_pars_fragment:Ny,lights_lambert_fragment:Oy,lights_lambert_pars_fragment:Fy,lights_pars_begin:By,lights_toon_fragment:zy,lights_toon_pars_fragment:Vy,lights_phong_fragment:Hy,lights_phong_pars_fragment:Gy,lights_physical_fragment:Wy,lights_physical_pars_fragment:Xy,lights_fragment_begin:qy,lights_fragment_maps:Yy,lights_fragment_end:$y,logdepthbuf_fragment:Zy,logdepthbuf_pars_fragment:Jy,logdepthbuf_pars_vertex:Ky,logdepthbuf_vertex:jy,map_fragment:Qy,map_pars_fragment:tv,map_particle_fragment:ev,map_particle_pars_fragment:nv,metalnessmap_fragment:iv,metalnessmap_pars_fragment:sv,morphinstance_vertex:rv,morphcolor_vertex:ov,morphnormal_vertex:av,morphtarget_pars_vertex:lv,morphtarget_vertex:cv,normal_fragment_begin:hv,normal_fragment_maps:uv,normal_pars_fragment:fv,normal_pars_vertex:dv,normal_vertex:pv,normalmap_pars_fragment:mv,clearcoat_normal_fragment_begin:gv,clearcoat_normal_fragment_maps:_v,clearcoat_pars_fragment:xv,iridescence_pars_fragment:yv,opaque_fragment:vv,packing:Mv,premultiplied_alpha_fragment:Sv,project_vertex:bv,dithering_fragment:wv,dithering_pars_fragment:Ev,roughnessmap_fragment:Tv,roughnessmap_pars_fragment:Av,shadowmap_pars_fragment:Cv,shadowmap_pars_vertex:Rv,shadowmap_vertex:Pv,shadowmask_pars_fragment:Iv,skinbase_vertex:Lv,skinning_pars_vertex:Dv,skinning_vertex:Uv,skinnormal_vertex:Nv,specularmap_fragment:Ov,specularmap_pars_fragment:Fv,tonemapping_fragment:Bv,tonemapping_pars_fragment:kv,transmission_fragment:zv,transmission_pars_fragment:Vv,uv_pars_fragment:Hv,uv_pars_vertex:Gv,uv_vertex:Wv,worldpos_vertex:Xv,background_vert:qv,background_frag:Yv,backgroundCube_vert:$v,backgroundCube_frag:Zv,cube_vert:Jv,cube_frag:Kv,depth_vert:jv,depth_frag:Qv,distanceRGBA_vert:tM,distanceRGBA_frag:eM,equirect_vert:nM,equirect_frag:iM,linedashed_vert:sM,linedashed_frag:rM,meshbasic_vert:oM,meshbasic_frag:aM,meshlambert_vert:lM,meshlambert_frag:cM,meshmatcap_vert:hM,meshmatcap_frag:uM,meshnormal_vert:fM,meshnormal_frag:dM,meshphong_vert:pM,meshphong_frag:mM,meshphysical_vert:gM,meshphysical_frag:_M,meshtoon_vert:xM,meshtoon_frag:yM,points_vert:vM,points_frag:MM,shadow_vert:SM,shadow_frag:bM,sprite_vert:wM,sprite_frag:EM},bt={common:{diffuse:{value:new pe(16777215)},opacity:{value:1},map:{value:null},mapTransform:{value:new oe},alphaMap:{value:null},alphaMapTransform:{value:new oe},alphaTest:{value:0}},specularmap:{specularMap:{value:null},specularMapTransform:{value:new oe}},envmap:{envMap:{value:null},envMapRotation:{value:new oe},flipEnvMap:{value:-1},reflectivity:{value:1},ior:{value:1.5},refractionRatio:{value:.98}},aomap:{aoMap:{value:null},aoMapIntensity:{value:1},aoMapTransform:{value:new oe}},lightmap:{lightMap:{value:null},lightMapIntensity:{value:1},lightMapTransform:{value:new oe}},bumpmap:{bumpMap:{value:null},bumpMapTransform:{value:new oe},bumpScale:{value:1}},normalmap:{normalMap:{value:null},normalMapTransform:{value:new oe},normalScale:{value:new se(1,1)}},displacementmap:{displacementMap:{value:null},displacementMapTransform:{value:new oe},displacementScale:{value:1},displacementBias:{value:0}},emissivemap:{emissiveMap:{value:null},emissiveMapTransform:{value:new oe}},metalnessmap:{metalnessMap:{value:null},metalnessMapTransform:{value:new oe}},roughnessmap:{roughnessMap:{value:null},roughnessMapTransform:{value:new oe}},gradientmap:{gradientMap:{value:null}},fog:{fogDensity:{value:25e-5},fogNear:{value:1},fogFar:{value:2e3},fogColor:{value:new pe(16777215)}},lights:{ambientLightColor:{value:[]},lightProbe:{value:[]},directionalLights:{value:[],properties:{direction:{},color:{}}},directionalLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},directionalShadowMap:{value:[]},directionalShadowMatrix:{value:[]},spotLights:{value:[],properties:{color:{},position:{},direction:{},distance:{},coneCos:{},penumbraCos:{},decay:{}}},spotLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{}}},spotLightMap:{value:[]},spotShadowMap:{value:[]},spotLightMatrix:{value:[]},pointLights:{value:[],properties:{color:{},position:{},decay:{},distance:{}}},pointLightShadows:{value:[],properties:{shadowIntensity:1,shadowBias:{},shadowNormalBias:{},shadowRadius:{},shadowMapSize:{},shadowCameraNear:{},shadowCameraFar:{}}},pointShadowMap:{value:[]},pointShadowMatrix:{value:[]},hemisphereLights:{value:[],properties:{direction:{},skyColor:{},groundColor:{}}},rectAreaLights:{value:[],properties:{color:{},position:{},width:{},height:{}}},ltc_1:{value:null},ltc_2:{value:null}},points:{diffuse:{value:new pe(16777215)},opacity:{value:1},size:{value:1},scale:{value:1},map:{value:null},alphaMap:{value:null},alphaMapTransform:{value:new oe},alphaTest:{value:0},uvTransform:{value:new oe}},sprite:{diffuse:{value:new pe(16777215)},opacity:{value:1},center:{value:new se(.5,.5)},rotation:{value:0},map:{value:null},mapTransform:{value:new oe},alphaMap:{value:null},alphaMapTransform:{value:new oe},alphaTest:{value:0}}},Pi={basic:{uniforms:Tn([bt.common,bt.specularmap,bt.envmap,bt.aomap,bt.lightmap,bt.fog]),vertexShader:ae.meshbasic_vert,fragmentShader:ae.meshbasic_frag},lambert:{uniforms:Tn([bt.common,bt.specularmap,bt.envmap,bt.aomap,bt.lightmap,bt.emissivemap,bt.bumpmap,bt.normalmap,bt.displacementmap,bt.fog,bt.lights,{emissive:{value:new pe(0)}}]),vertexShader:ae.meshlambert_vert,fragmentShader:ae.meshlambert_frag},phong:{uniforms:Tn([bt.common,bt.specularmap,bt.envmap,bt.aomap,bt.lightmap,bt.emissivemap,bt.bumpmap,bt.normalmap,bt.displacementmap,bt.fog,bt.lights,{emissive:{value:new pe(0)},specular:{value:new pe(1118481)},shininess:{value:30}}]),vertexShader:ae.meshphong_vert,fragmentShader:ae.meshphong_frag},standard:{uniforms:Tn([bt.common,bt.envmap,bt.aomap,bt.lightmap,bt.emissivemap,bt.bumpmap,bt.normalmap,bt.displacementmap,bt.roughnessmap,bt.metalnessmap,bt.fog,bt.lights,{emissive:{value:new pe(0)},roughness:{value:1},metalness:{value:0},envMapIntensity:{value:1}}]),vertexShader:ae.meshphysical_vert,fragmentShader:ae.meshphysical_frag},toon:{uniforms:Tn([bt.common,bt.aomap,bt.lightmap,bt.emissivemap,bt.bumpmap,bt.normalmap,bt.displacementmap,bt.gradientmap,bt.fog,bt.lights,{emissive:{value:new pe(0)}}]),vertexShader:ae.meshtoon_vert,fragmentShader:ae.meshtoon_frag},matcap:{uniforms:Tn([bt.common,bt.bumpmap,bt.normalmap,bt.displacementmap,bt.fog,{matcap:{value:null}}]),vertexShader:ae.meshmatcap_vert,fragmentShader:ae.meshmatcap_frag},points:{uniforms:Tn([bt.points,bt.fog]),vertexShader:ae.points_vert,fragmentShader:ae.points_frag},dashed:{uniforms:Tn([bt.common,bt.fog,{scale:{value:1},dashSize:{value:1},totalSize:{value:2}}]),vertexShader:ae.linedashed_vert,fragmentShader:ae.linedashed_frag},depth:{uniforms:Tn([bt.common,bt.displacementmap]),vertexShader:ae.depth_vert,fragmentShader:ae.depth_frag},normal:{uniforms:Tn([bt.common,bt.bumpmap,bt.normalmap,bt.displacementmap,{opacity:{value:1}}]),vertexShader:ae.meshnormal_vert,fragmentShader:ae.meshnormal_frag},sprite:{uniforms:Tn([bt.sprite,bt.fog]),vertexShader:ae.sprite_vert,fragmentShader:ae.sprite_frag},background:{uniforms:{uvTransform:{value:new oe},t2D:{value:null},backgroundIntensity:{value:1}},vertexShader:ae.background_vert,fragmentShader:ae.background_frag},backgroundCube:{uniforms:{envMap:{value:null},flipEnvMap:{value:-1},backgroundBlurriness:{value:0},backgroundIntensity:{value:1},backgroundRotation:{value:new oe}},vertexShader:ae.backgroundCube_vert,fragmentShader:ae.backgroundCube_frag},cube:{uniforms:{tCube:{value:null},tFlip:{value:-1},opacity:{value:1}},vertexShader:ae.cube_vert,fragmentShader:ae.cube_frag},equirect:{uniforms:{tEquirect:{value:null}},vertexShader:ae.equirect_vert,fragmentShader:ae.equirect_frag},distanceRGBA:{uniforms:Tn([bt.common,bt.displacementmap,{referencePosition:{value:new Y},nearDistance:{value:1},farDistance:{value:1e3}}]),vertexShader:ae.distanceRGBA_vert,fragmentShader:ae.distanceRGBA_frag},shadow:{uniforms:Tn([bt.lights,bt.fog,{color:{value:new pe(0)},opacity:{value:1}}]),vertexShader:ae.shadow_vert,fragmentShader:ae.shadow_frag}};Pi.physical={uniforms:Tn([Pi.standard.uniforms,{clearcoat:{value:0},clearcoatMap:{value:null},clearcoatMapTransform:{value:new oe},clearcoatNormalMap:{value:null},clearcoatNormalMapTransform:{value:new oe},clearcoatNormalScale:{value:new se(1,1)},clearcoatRoughness:{value:0},clearcoatRoughnessMap:{value:null},clearcoatRoughnessMapTransform:{value:new oe},dispersion:{value:0},iridescence:{value:0},iridescenceMap:{value:null},iridescenceMapTransform:{value:new oe},iridescenceIOR:{value:1.3},iridescenceThicknessMinimum:{value:100},iridescenceThicknessMaximum:{value:400},iridescenceThicknessMap:{value:null},iridescenceThicknessMapTransform:{value:new oe},sheen:{value:0},sheenColor:{value:new pe(0)},sheenColorMap:{value:null},sheenColorMapTransform:{value:new oe},sheenRoughness:{value:1},sheenRoughnessMap:{value:null},sheenRoughnessMapTransform:{value:new oe},transmission:{value:0},transmissionMap:{value:null},transmissionMapTransform:{value:new oe},transmissionSamplerSize:{value:new se},transmissionSamplerMap:{value:null},thickness:{value:0},thicknessMap:{value:null},thicknessMapTransform:{value:new oe},attenuationDistance:{value:0},attenuationColor:{value:new pe(0)},specularColor:{value:new pe(1,1,1)},specularColorMap:{value:null},specularColorMapTransform:{value:new oe},specularIntensity:{value:1},specularIntensityMap:{value:null},specularIntensityMapTransform:{value:new oe},anisotropyVector:{value:new se},anisotropyMap:{value:null},anisotropyMapTransform:{value:new oe}}]),vertexShader:ae.meshphysical_vert,fragmentShader:ae.meshphysical_frag};var Ha={r:0,b:0,g:0},Gs=new Li,TM=new Ge;function AM(i,t,e,n,s,r,o){let a=new pe(0),l=r===!0?0:1,c,u,f=null,h=0,p=null;function _(S){let v=S.isScene===!0?S.background:null;return v&&v.isTexture&&(v=(S.backgroundBlurriness>0?e:t).get(v)),v}function g(S){let v=!1,y=_(S);y===null?d(a,l):y&&y.isColor&&(d(y,1),v=!0);let I=i.xr.getEnvironmentBlendMode();I==="additive"?n.buffers.color.setClear(0,0,0,1,o):I==="alpha-blend"&&n.buffers.color.setClear(0,0,0,0,o),(i.autoClear||v)&&(n.buffers.depth.setTest(!0),n.buffers.depth.setMask(!0),n.buffers.color.setMask(!0),i.clear(i.autoClearColor,i.autoClearDepth,i.autoClearStencil))}function m(S,v){let y=_(v);y&&(y.isCubeTexture||y.mapping===wl)?(u===void 0&&(u=new Cn(new zo(1,1,1),new Di({name:"BackgroundCubeMaterial",uniforms:no(Pi.backgroundCube.uniforms),vertexShader:Pi.backgroundCube.vertexShader,fragmentShader:Pi.backgroundCube.fragmentShader,side:Nn,depthTest:!1,depthWrite:!1,fog:!1})),u.geometry.deleteAttribute("normal"),u.geometry.deleteAttribute("uv"),u.onBeforeRender=function(I,C,R){this.matrixWorld.copyPosition(R.matrixWorld)},Object.defineProperty(u.material,"envMap",{get:function(){return this.uniforms.envMap.value}}),s.update(u)),Gs.copy(v.backgroundRotation),Gs.x*=-1,Gs.y*=-1,Gs.z*=-1,y.isCubeTexture&&y.isRenderTargetTexture===!1&&(Gs.y*=-1,Gs.z*=-1),u.material.uniforms.envMap.value=y,u.material.uniforms.flipEnvMap.value=y.isCubeTexture&&y.isRenderTargetTexture===!1?-1:1,u.material.uniforms.backgroundBlurriness.value=v.backgroundBlurriness,u.material.uniforms.backgroundIntensity.value=v.backgroundIntensity,u.material.uniforms.backgroundRotation.value.setFromMatrix4(TM.makeRotationFromEuler(Gs)),u.material.toneMapped=ye.getTransfer(y.colorSpace)!==Ce,(f!==y||h!==y.version||p!==i.toneMapping)&&(u.material.needsUpdate=!0,f=y,h=y.version,p=i.toneMapping),u.layers.enableAll(),S.unshift(u,u.geometry,u.material,0,0,null)):y&&y.isTexture&&(c===void 0&&(c=new Cn(new cl(2,2),new Di({name:"BackgroundMaterial",uniforms:no(Pi.background.uniforms),vertexShader:Pi.background.vertexShader,fragmentShader:Pi.background.fragmentShader,side:Ms,depthTest:!1,depthWrite:!1,fog:!1})),c.geometry.deleteAttribute("normal"),Object.defineProperty(c.material,"map",{get:function(){return this.uniforms.t2D.value}}),s.update(c)),c.material.uniforms.t2D.value=y,c.material.uniforms.backgroundIntensity.value=v.backgroundIntensity,c.material.toneMapped=ye.getTransfer(y.colorSpace)!==Ce,y.matrixAutoUpdate===!0&&y.updateMatrix(),c.material.uniforms.uvTransform.value.copy(y.matrix),(f!==y||h!==y.version||p!==i.toneMapping)&&(c.material.needsUpdate=!0,f=y,h=y.version,p=i.toneMapping),c.layers.enableAll(),S.unshift(c,c.geometry,c.material,0,0,null))}function d(S,v){S.getRGB(Ha,Im(i)),n.buffers.color.setClear(Ha.r,Ha.g,Ha.b,v,o)}return{getClearColor:function(){return a},setClearColor:function(S,v=1){a.set(S),l=v,d(a,l)},getClearAlpha:function(){return l},setClearAlpha:function(S){l=S,d(a,l)},render:g,addToRenderList:m}}function CM(i,t){let e=i.getParameter(i.MAX_VERTEX_ATTRIBS),n={},s=h(null),r=s,o=!1;function a(b,A,O,F,G){let $=!1,W=f(F,O,A);r!==W&&(r=W,c(r.object)),$=p(b,F,O,G),$&&_(b,F,O,G),G!==null&&t.update(G,i.ELEMENT_ARRAY_BUFFER),($||o)&&(o=!1,y(b,A,O,F),G!==null&&i.bindBuffer(i.ELEMENT_ARRAY_BUFFER,t.get(G).buffer))}function l(){return i.createVertexArray()}function c(b){return i.bindVertexArray(b)}function u(b){return i.deleteVertexArray(b)}function f(b,A,O){let F=O.wireframe===!0,G=n[b.id];G===void 0&&(G={},n[b.id]=G);let $=G[A.id];$===void 0&&($={},G[A.id]=$);let W=$[F];return W===void 0&&(W=h(l()),$[F]=W),W}function h(b){let A=[],O=[],F=[];for(let G=0;G<e;G++)A[G]=0,O[G]=0,F[G]=0;return{geometry:null,program:null,wireframe:!1,newAttributes:A,enabledAttributes:O,attributeDivisors:F,object:b,attributes:{},index:null}}function p(b,A,O,F){let G=r.attributes,$=A.attributes,W=0,Z=O.getAttributes();for(let J in Z)if(Z[J].location>=0){let lt=G[J],_t=$[J];if(_t===void 0&&(J==="instanceMatrix"&&b.instanceMatrix&&(_t=b.instanceMatrix),J==="instanceColor"&&b.instanceColor&&(_t=b.instanceColor)),lt===void 0||lt.attribute!==_t||_t&&lt.data!==_t.data)return!0;W++}return r.attributesNum!==W||r.index!==F}function _(b,A,O,F){let G={},$=A.attributes,W=0,Z=O.getAttributes();for(let J in Z)if(Z[J].location>=0){let lt=$[J];lt===void 0&&(J==="instanceMatrix"&&b.instanceMatrix&&(lt=b.instanceMatrix),J==="instanceColor"&&b.instanceColor&&(lt=b.instanceColor));let _t={};_t.attribute=lt,lt&&lt.data&&(_t.data=lt.data),G[J]=_t,W++}r.attributes=G,r.attributesNum=W,r.index=F}function g(){let b=r.newAttributes;for(let A=0,O=b.length;A<O;A++)b[A]=0}function m(b){d(b,0)}function d(b,A){let O=r.newAttributes,F=r.enabledAttributes,G=r.attributeDivisors;O[b]=1,F[b]===0&&(i.enableVertexAttribArray(b),F[b]=1),G[b]!==A&&(i.vertexAttribDivisor(b,A),G[b]=A)}function S(){let b=r.newAttributes,A=r.enabledAttributes;for(let O=0,F=A.length;O<F;O++)A[O]!==b[O]&&(i.disableVertexAttribArray(O),A[O]=0)}function v(b,A,O,F,G,$,W){W===!0?i.vertexAttribIPointer(b,A,O,G,$):i.vertexAttribPointer(b,A,O,F,G,$)}function y(b,A,O,F){g();let G=F.attributes,$=O.getAttributes(),W=A.defaultAttributeValues;for(let Z in $){let J=$[Z];if(J.location>=0){let ct=G[Z];if(ct===void 0&&(Z==="instanceMatrix"&&b.instanceMatrix&&(ct=b.instanceMatrix),Z==="instanceColor"&&b.instanceColor&&(ct=b.instanceColor)),ct!==void 0){let lt=ct.normalized,_t=ct.itemSize,dt=t.get(ct);if(dt===void 0)continue;let Yt=dt.buffer,Q=dt.type,ht=dt.bytesPerElement,Bt=Q===i.INT||Q===i.UNSIGNED_INT||ct.gpuType===Eu;if(ct.isInterleavedBufferAttribute){let pt=ct.data,zt=pt.stride,j=ct.offset;if(pt.isInstancedInterleavedBuffer){for(let st=0;st<J.locationSize;st++)d(J.location+st,pt.meshPerAttribute);b.isInstancedMesh!==!0&&F._maxInstanceCount===void 0&&(F._maxInstanceCount=pt.meshPerAttribute*pt.count)}else for(let st=0;st<J.locationSize;st++)m(J.location+st);i.bindBuffer(i.ARRAY_BUFFER,Yt);for(let st=0;st<J.locationSize;st++)v(J.location+st,_t/J.locationSize,Q,lt,zt*ht,(j+_t/J.locationSize*st)*ht,Bt)}else{if(ct.isInstancedBufferAttribute){for(let pt=0;pt<J.locationSize;pt++)d(J.location+pt,ct.meshPerAttribute);b.isInstancedMesh!==!0&&F._maxInstanceCount===void 0&&(F._maxInstanceCount=ct.meshPerAttribute*ct.count)}else for(let pt=0;pt<J.locationSize;pt++)m(J.location+pt);i.bindBuffer(i.ARRAY_BUFFER,Yt);for(let pt=0;pt<J.locationSize;pt++)v(J.location+pt,_t/J.locationSize,Q,lt,_t*ht,_t/J.locationSize*pt*ht,Bt)}}else if(W!==void 0){let lt=W[Z];if(lt!==void 0)switch(lt.length){case 2:i.vertexAttrib2fv(J.location,lt);break;case 3:i.vertexAttrib3fv(J.location,lt);break;case 4:i.vertexAttrib4fv(J.location,lt);break;default:i.vertexAttrib1fv(J.location,lt)}}}}S()}function I(){L();for(let b in n){let A=n[b];for(let O in A){let F=A[O];for(let G in F)u(F[G].object),delete F[G];delete A[O]}delete n[b]}}function C(b){if(n[b.id]===void 0)return;let A=n[b.id];for(let O in A){let F=A[O];for(let G in F)u(F[G].object),delete F[G];delete A[O]}delete n[b.id]}function R(b){for(let A in n){let O=n[A];if(O[b.id]===void 0)continue;let F=O[b.id];for(let G in F)u(F[G].object),delete F[G];delete O[b.id]}}function L(){E(),o=!0,r!==s&&(r=s,c(r.object))}function E(){s.geometry=null,s.program=null,s.wireframe=!1}return{setup:a,reset:L,resetDefaultState:E,dispose:I,releaseStatesOfGeometry:C,releaseStatesOfProgram:R,initAttributes:g,enableAttribute:m,disableUnusedAttributes:S}}function RM(i,t,e){let n;function s(c){n=c}function r(c,u){i.drawArrays(n,c,u),e.update(u,n,1)}function o(c,u,f){f!==0&&(i.drawArraysInstanced(n,c,u,f),e.update(u,n,f))}function a(c,u,f){if(f===0)return;t.get("WEBGL_multi_draw").multiDrawArraysWEBGL(n,c,0,u,0,f);let p=0;for(let _=0;_<f;_++)p+=u[_];e.update(p,n,1)}function l(c,u,f,h){if(f===0)return;let p=t.get("WEBGL_multi_draw");if(p===null)for(let _=0;_<c.length;_++)o(c[_],u[_],h[_]);else{p.multiDrawArraysInstancedWEBGL(n,c,0,u,0,h,0,f);let _=0;for(let g=0;g<f;g++)_+=u[g]*h[g];e.update(_,n,1)}}this.setMode=s,this.render=r,this.renderInstances=o,this.renderMultiDraw=a,this.renderMultiDrawInstances=l}function PM(i,t,e,n){let s;function r(){if(s!==void 0)return s;if(t.has("EXT_texture_filter_anisotropic")===!0){let R=t.get("EXT_texture_filter_anisotropic");s=i.getParameter(R.MAX_TEXTURE_MAX_ANISOTROPY_EXT)}else s=0;return s}function o(R){return!(R!==_i&&n.convert(R)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_FORMAT))}function a(R){let L=R===Xo&&(t.has("EXT_color_buffer_half_float")||t.has("EXT_color_buffer_float"));return!(R!==ji&&n.convert(R)!==i.getParameter(i.IMPLEMENTATION_COLOR_READ_TYPE)&&R!==$i&&!L)}function l(R){if(R==="highp"){if(i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.HIGH_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.HIGH_FLOAT).precision>0)return"highp";R="mediump"}return R==="mediump"&&i.getShaderPrecisionFormat(i.VERTEX_SHADER,i.MEDIUM_FLOAT).precision>0&&i.getShaderPrecisionFormat(i.FRAGMENT_SHADER,i.MEDIUM_FLOAT).precision>0?"mediump":"lowp"}let c=e.precision!==void 0?e.precision:"highp",u=l(c);u!==c&&(console.warn("THREE.WebGLRenderer:",c,"not supported, using",u,"instead."),c=u);let f=e.logarithmicDepthBuffer===!0,h=e.reverseDepthBuffer===!0&&t.has("EXT_clip_control"),p=i.getParameter(i.MAX_TEXTURE_IMAGE_UNITS),_=i.getParameter(i.MAX_VERTEX_TEXTURE_IMAGE_UNITS),g=i.getParameter(i.MAX_TEXTURE_SIZE),m=i.getParameter(i.MAX_CUBE_MAP_TEXTURE_SIZE),d=i.getParameter(i.MAX_VERTEX_ATTRIBS),S=i.getParameter(i.MAX_VERTEX_UNIFORM_VECTORS),v=i.getParameter(i.MAX_VARYING_VECTORS),y=i.getParameter(i.MAX_FRAGMENT_UNIFORM_VECTORS),I=_>0,C=i.getParameter(i.MAX_SAMPLES);return{isWebGL2:!0,getMaxAnisotropy:r,getMaxPrecision:l,textureFormatReadable:o,textureTypeReadable:a,precision:c,logarithmicDepthBuffer:f,reverseDepthBuffer:h,maxTextures:p,maxVertexTextures:_,maxTextureSize:g,maxCubemapSize:m,maxAttributes:d,maxVertexUniforms:S,maxVaryings:v,maxFragmentUniforms:y,vertexTextures:I,maxSamples:C}}function IM(i){let t=this,e=null,n=0,s=!1,r=!1,o=new gi,a=new oe,l={value:null,needsUpdate:!1};this.uniform=l,this.numPlanes=0,this.numIntersection=0,this.init=function(f,h){let p=f.length!==0||h||n!==0||s;return s=h,n=f.length,p},this.beginShadows=function(){r=!0,u(null)},this.endShadows=function(){r=!1},this.setGlobalState=function(f,h){e=u(f,h,0)},this.setState=function(f,h,p){let _=f.clippingPlanes,g=f.clipIntersection,m=f.clipShadows,d=i.get(f);if(!s||_===null||_.length===0||r&&!m)r?u(null):c();else{let S=r?0:n,v=S*4,y=d.clippingState||null;l.value=y,y=u(_,h,v,p);for(let I=0;I!==v;++I)y[I]=e[I];d.clippingState=y,this.numIntersection=g?this.numPlanes:0,this.numPlanes+=S}};function c(){l.value!==e&&(l.value=e,l.needsUpdate=n>0),t.numPlanes=n,t.numIntersection=0}function u(f,h,p,_){let g=f!==null?f.length:0,m=null;if(g!==0){if(m=l.value,_!==!0||m===null){let d=p+g*4,S=h.matrixWorldInverse;a.getNormalMatrix(S),(m===null||m.length<d)&&(m=new Float32Array(d));for(let v=0,y=p;v!==g;++v,y+=4)o.copy(f[v]).applyMatrix4(S,a),o.normal.toArray(m,y),m[y+3]=o.constant}l.value=m,l.needsUpdate=!0}return t.numPlanes=g,t.numIntersection=0,m}}function LM(i){let t=new WeakMap;function e(o,a){return a===yh?o.mapping=Zr:a===vh&&(o.mapping=Jr),o}function n(o){if(o&&o.isTexture){let a=o.mapping;if(a===yh||a===vh)if(t.has(o)){let l=t.get(o).texture;return e(l,o.mapping)}else{let l=o.image;if(l&&l.height>0){let c=new tu(l.height);return c.fromEquirectangularTexture(i,o),t.set(o,c),o.addEventListener("dispose",s),e(c.texture,o.mapping)}else return null}}return o}function s(o){let a=o.target;a.removeEventListener("dispose",s);let l=t.get(a);l!==void 0&&(t.delete(a),l.dispose())}function r(){t=new WeakMap}return{get:n,dispose:r}}var hl=class extends al{constructor(t=-1,e=1,n=1,s=-1,r=.1,o=2e3){super(),this.isOrthographicCamera=!0,this.type="OrthographicCamera",this.zoom=1,this.view=null,this.left=t,this.right=e,this.top=n,this.bottom=s,this.near=r,this.far=o,this.updateProjectionMatrix()}copy(t,e){return super.copy(t,e),this.left=t.left,this.right=t.right,this.top=t.top,this.bottom=t.bottom,this.near=t.near,this.far=t.far,this.zoom=t.zoom,this.view=t.view===null?null:Object.assign({},t.view),this}setViewOffset(t,e,n,s,r,o){this.view===null&&(this.view={enabled:!0,fullWidth:1,fullHeight:1,offsetX:0,offsetY:0,width:1,height:1}),this.view.enabled=!0,this.view.fullWidth=t,this.view.fullHeight=e,this.view.offsetX=n,this.view.offsetY=s,this.view.width=r,this.view.height=o,this.updateProjectionMatrix()}clearViewOffset(){this.view!==null&&(this.view.enabled=!1),this.updateProjectionMatrix()}updateProjectionMatrix(){let t=(this.right-this.left)/(2*this.zoom),e=(this.top-this.bottom)/(2*this.zoom),n=(this.right+this.left)/2,s=(this.top+this.bottom)/2,r=n-t,o=n+t,a=s+e,l=s-e;if(this.view!==null&&this.view.enabled){let c=(this.right-this.left)/this.view.fullWidth/this.zoom,u=(this.top-this.bottom)/this.view.fullHeight/this.zoom;r+=c*this.view.offsetX,o=r+c*this.view.width,a-=u*this.view.offsetY,l=a-u*this.view.height}this.projectionMatrix.makeOrthographic(r,o,a,l,this.near,this.far,this.coordinateSystem),this.projectionMatrixInverse.copy(this.projectionMatrix).invert()}toJSON(t){let e=super.toJSON(t);return e.object.zoom=this.zoom,e.object.left=this.left,e.object.right=this.right,e.object.top=this.top,e.object.bottom=this.bottom,e.object.near=this.near,e.object.far=this.far,this.view!==null&&(e.object.view=Object.assign({},this.view)),e}},Gr=4,Fp=[.125,.215,.35,.446,.526,.582],$s=20,nh=new hl,Bp=new pe,ih=null,sh=0,rh=0,oh=!1,Xs=(1+Math.sqrt(5))/2,Vr=1/Xs,kp=[new Y(-Xs,Vr,0),new Y(Xs,Vr,0),new Y(-Vr,0,Xs),new Y(Vr,0,Xs),new Y(0,Xs,-Vr),new Y(0,Xs,Vr),new Y(-1,1,-1),new Y(1,1,-1),new Y(-1,1,1),new Y(1,1,1)],ul=class{constructor(t){this._renderer=t,this._pingPongRenderTarget=null,this._lodMax=0,this._cubeSize=0,this._lodPlanes=[],this._sizeLods=[],this._sigmas=[],this._blurMaterial=null,this._cubemapMaterial=null,this._equirectMaterial=null,this._compileMaterial(this._blurMaterial)}fromScene(t,e=0,n=.1,s=100){ih=this._renderer.getRenderTarget(),sh=this._renderer.getActiveCubeFace(),rh=this._renderer.getActiveMipmapLevel(),oh=this._renderer.xr.enabled,this._renderer.xr.enabled=!1,this._setSize(256);let r=this._allocateTargets();return r.depthBuffer=!0,this._sceneToCubeUV(t,n,s,r),e>0&&this._blur(r,0,0,e),this._applyPMREM(r),this._cleanup(r),r}fromEquirectangular(t,e=null){return this._fromTexture(t,e)}fromCubemap(t,e=null){return this._fromTexture(t,e)}compileCubemapShader(){this._cubemapMaterial===null&&(this._cubemapMaterial=Hp(),this._compileMaterial(this._cubemapMaterial))}compileEquirectangularShader(){this._equirectMaterial===null&&(this._equirectMaterial=Vp(),this._compileMaterial(this._equirectMaterial))}dispose(){this._dispose(),this._cubemapMaterial!==null&&this._cubemapMaterial.dispose(),this._equirectMaterial!==null&&this._equirectMaterial.dispose()}_setSize(t){this._lodMax=Math.floor(Math.log2(t)),this._cubeSize=Math.pow(2,this._lodMax)}_dispose(){this._blurMaterial!==null&&this._blurMaterial.dispose(),this._pingPongRenderTarget!==null&&this._pingPongRenderTarget.dispose();for(let t=0;t<this._lodPlanes.length;t++)this._lodPlanes[t].dispose()}_cleanup(t){this._renderer.setRenderTarget(ih,sh,rh),this._renderer.xr.enabled=oh,t.scissorTest=!1,Ga(t,0,0,t.width,t.height)}_fromTexture(t,e){t.mapping===Zr||t.mapping===Jr?this._setSize(t.image.length===0?16:t.image[0].width||t.image[0].image.width):this._setSize(t.image.width/4),ih=this._renderer.getRenderTarget(),sh=this._renderer.getActiveCubeFace(),rh=this._renderer.getActiveMipmapLevel(),oh=this._renderer.xr.enabled,this._renderer.xr.enabled=!1;let n=e||this._allocateTargets();return this._textureToCubeUV(t,n),this._applyPMREM(n),this._cleanup(n),n}_allocateTargets(){let t=3*Math.max(this._cubeSize,112),e=4*this._cubeSize,n={magFilter:Ii,minFilter:Ii,generateMipmaps:!1,type:Xo,format:_i,colorSpace:ro,depthBuffer:!1},s=zp(t,e,n);if(this._pingPongRenderTarget===null||this._pingPongRenderTarget.width!==t||this._pingPongRenderTarget.height!==e){this._pingPongRenderTarget!==null&&this._dispose(),this._pingPongRenderTarget=zp(t,e,n);let{_lodMax:r}=this;({sizeLods:this._sizeLods,lodPlanes:this._lodPlanes,sigmas:this._sigmas}=DM(r)),this._blurMaterial=UM(r,t,e)}return s}_compileMaterial(t){let e=new Cn(this._lodPlanes[0],t);this._renderer.compile(e,nh)}_sceneToCubeUV(t,e,n,s){let a=new An(90,1,e,n),l=[1,-1,1,1,1,1],c=[1,1,1,-1,-1,-1],u=this._renderer,f=u.autoClear,h=u.toneMapping;u.getClearColor(Bp),u.toneMapping=vs,u.autoClear=!1;let p=new eo({name:"PMREM.Background",side:Nn,depthWrite:!1,depthTest:!1}),_=new Cn(new zo,p),g=!1,m=t.background;m?m.isColor&&(p.color.copy(m),t.background=null,g=!0):(p.color.copy(Bp),g=!0);for(let d=0;d<6;d++){let S=d%3;S===0?(a.up.set(0,l[d],0),a.lookAt(c[d],0,0)):S===1?(a.up.set(0,0,l[d]),a.lookAt(0,c[d],0)):(a.up.set(0,l[d],0),a.lookAt(0,0,c[d]));let v=this._cubeSize;Ga(s,S*v,d>2?v:0,v,v),u.setRenderTarget(s),g&&u.render(_,a),u.render(t,a)}_.geometry.dispose(),_.material.dispose(),u.toneMapping=h,u.autoClear=f,t.background=m}_textureToCubeUV(t,e){let n=this._renderer,s=t.mapping===Zr||t.mapping===Jr;s?(this._cubemapMaterial===null&&(this._cubemapMaterial=Hp()),this._cubemapMaterial.uniforms.flipEnvMap.value=t.isRenderTargetTexture===!1?-1:1):this._equirectMaterial===null&&(this._equirectMaterial=Vp());let r=s?this._cubemapMaterial:this._equirectMaterial,o=new Cn(this._lodPlanes[0],r),a=r.uniforms;a.envMap.value=t;let l=this._cubeSize;Ga(e,0,0,3*l,2*l),n.setRenderTarget(e),n.render(o,nh)}_applyPMREM(t){let e=this._renderer,n=e.autoClear;e.autoClear=!1;let s=this._lodPlanes.length;for(let r=1;r<s;r++){let o=Math.sqrt(this._sigmas[r]*this._sigmas[r]-this._sigmas[r-1]*this._sigmas[r-1]),a=kp[(s-r-1)%kp.length];this._blur(t,r-1,r,o,a)}e.autoClear=n}_blur(t,e,n,s,r){let o=this._pingPongRenderTarget;this._halfBlur(t,o,e,n,s,"latitudinal",r),this._halfBlur(o,t,n,n,s,"longitudinal",r)}_halfBlur(t,e,n,s,r,o,a){let l=this._renderer,c=this._blurMaterial;o!=="latitudinal"&&o!=="longitudinal"&&console.error("blur direction must be either latitudinal or longitudinal!");let u=3,f=new Cn(this._lodPlanes[s],c),h=c.uniforms,p=this._sizeLods[n]-1,_=isFinite(r)?Math.PI/(2*p):2*Math.PI/(2*$s-1),g=r/_,m=isFinite(r)?1+Math.floor(u*g):$s;m>$s&&console.warn(`sigmaRadians, ${r}, is too large and will clip, as it requested ${m} samples when the maximum is set to ${$s}`);let d=[],S=0;for(let R=0;R<$s;++R){let L=R/g,E=Math.exp(-L*L/2);d.push(E),R===0?S+=E:R<m&&(S+=2*E)}for(let R=0;R<d.length;R++)d[R]=d[R]/S;h.envMap.value=t.texture,h.samples.value=m,h.weights.value=d,h.latitudinal.value=o==="latitudinal",a&&(h.poleAxis.value=a);let{_lodMax:v}=this;h.dTheta.value=_,h.mipInt.value=v-n;let y=this._sizeLods[s],I=3*y*(s>v-Gr?s-v+Gr:0),C=4*(this._cubeSize-y);Ga(e,I,C,3*y,2*y),l.setRenderTarget(e),l.render(f,nh)}};function DM(i){let t=[],e=[],n=[],s=i,r=i-Gr+1+Fp.length;for(let o=0;o<r;o++){let a=Math.pow(2,s);e.push(a);let l=1/a;o>i-Gr?l=Fp[o-i+Gr-1]:o===0&&(l=0),n.push(l);let c=1/(a-2),u=-c,f=1+c,h=[u,u,f,u,f,f,u,u,f,f,u,f],p=6,_=6,g=3,m=2,d=1,S=new Float32Array(g*_*p),v=new Float32Array(m*_*p),y=new Float32Array(d*_*p);for(let C=0;C<p;C++){let R=C%3*2/3-1,L=C>2?0:-1,E=[R,L,0,R+2/3,L,0,R+2/3,L+1,0,R,L,0,R+2/3,L+1,0,R,L+1,0];S.set(E,g*_*C),v.set(h,m*_*C);let b=[C,C,C,C,C,C];y.set(b,d*_*C)}let I=new Bn;I.setAttribute("position",new pn(S,g)),I.setAttribute("uv",new pn(v,m)),I.setAttribute("faceIndex",new pn(y,d)),t.push(I),s>Gr&&s--}return{lodPlanes:t,sizeLods:e,sigmas:n}}function zp(i,t,e){let n=new ts(i,t,e);return n.texture.mapping=wl,n.texture.name="PMREM.cubeUv",n.scissorTest=!0,n}function Ga(i,t,e,n,s){i.viewport.set(t,e,n,s),i.scissor.set(t,e,n,s)}function UM(i,t,e){let n=new Float32Array($s),s=new Y(0,1,0);return new Di({name:"SphericalGaussianBlur",defines:{n:$s,CUBEUV_TEXEL_WIDTH:1/t,CUBEUV_TEXEL_HEIGHT:1/e,CUBEUV_MAX_MIP:`${i}.0`},uniforms:{envMap:{value:null},samples:{value:1},weights:{value:n},latitudinal:{value:!1},dTheta:{value:0},mipInt:{value:0},poleAxis:{value:s}},vertexShader:Lu(),fragmentShader:`

			precision mediump float;
			precision mediump int;

			varying vec3 vOutputDirection;

			uniform sampler2D envMap;
			uniform int samples;
			uniform float weights[ n ];
			uniform bool latitudinal;
			uniform float dTheta;
			uniform float mipInt;
			uniform vec3 poleAxis;

			#define ENVMAP_TYPE_CUBE_UV
			#include <cube_uv_reflection_fragment>

			vec3 getSample( float theta, vec3 axis ) {

				float cosTheta = cos( theta );
				// Rodrigues' axis-angle rotation
				vec3 sampleDirection = vOutputDirection * cosTheta
					+ cross( axis, vOutputDirection ) * sin( theta )
					+ axis * dot( axis, vOutputDirection ) * ( 1.0 - cosTheta );

				return bilinearCubeUV( envMap, sampleDirection, mipInt );

			}

			void main() {

				vec3 axis = latitudinal ? poleAxis : cross( poleAxis, vOutputDirection );

				if ( all( equal( axis, vec3( 0.0 ) ) ) ) {

					axis = vec3( vOutputDirection.z, 0.0, - vOutputDirection.x );

				}

				axis = normalize( axis );

				gl_FragColor = vec4( 0.0, 0.0, 0.0, 1.0 );
				gl_FragColor.rgb += weights[ 0 ] * getSample( 0.0, axis );

				for ( int i = 1; i < n; i++ ) {

					if ( i >= samples ) {

						break;

					}

					float theta = dTheta * float( i );
					gl_FragColor.rgb += weights[ i ] * getSample( -1.0 * theta, axis );
					gl_FragColor.rgb += weights[ i ] * getSample( theta, axis );

				}

			}
		`,blending:ys,depthTest:!1,depthWrite:!1})}function Vp(){return new Di({name:"EquirectangularToCubeUV",uniforms:{envMap:{value:null}},vertexShader:Lu(),fragmentShader:`

			precision mediump float;
			precision mediump int;

			varying vec3 vOutputDirection;

			uniform sampler2D envMap;

			#include <common>

			void main() {

				vec3 outputDirection = normalize( vOutputDirection );
				vec2 uv = equirectUv( outputDirection );

				gl_FragColor = vec4( texture2D ( envMap, uv ).rgb, 1.0 );

			}
		`,blending:ys,depthTest:!1,depthWrite:!1})}function Hp(){return new Di({name:"CubemapToCubeUV",uniforms:{envMap:{value:null},flipEnvMap:{value:-1}},vertexShader:Lu(),fragmentShader:`

			precision mediump float;
			precision mediump int;

			uniform float flipEnvMap;

			varying vec3 vOutputDirection;

			uniform samplerCube envMap;

			void main() {

				gl_FragColor = textureCube( envMap, vec3( flipEnvMap * vOutputDirection.x, vOutputDirection.yz ) );

			}
		`,blending:ys,depthTest:!1,depthWrite:!1})}function Lu(){return`

		precision mediump float;
		precision mediump int;

		attribute float faceIndex;

		varying vec3 vOutputDirection;

		// RH coordinate system; PMREM face-indexing convention
		vec3 getDirection( vec2 uv, float face ) {

			uv = 2.0 * uv - 1.0;

			vec3 direction = vec3( uv, 1.0 );

			if ( face == 0.0 ) {

				direction = direction.zyx; // ( 1, v, u ) pos x

			} else if ( face == 1.0 ) {

				direction = direction.xzy;
				direction.xz *= -1.0; // ( -u, 1, -v ) pos y

			} else if ( face == 2.0 ) {

				direction.x *= -1.0; // ( -u, v, 1 ) pos z

			} else if ( face == 3.0 ) {

				direction = direction.zyx;
				direction.xz *= -1.0; // ( -1, v, -u ) neg x

			} else if ( face == 4.0 ) {

				direction = direction.xzy;
				direction.xy *= -1.0; // ( -u, -1, v ) neg y

			} else if ( face == 5.0 ) {

				direction.z *= -1.0; // ( u, v, -1 ) neg z

			}

			return direction;

		}

		void main() {

			vOutputDirection = getDirection( uv, faceIndex );
			gl_Position = vec4( position, 1.0 );

		}
	`}function NM(i){let t=new WeakMap,e=null;function n(a){if(a&&a.isTexture){let l=a.mapping,c=l===yh||l===vh,u=l===Zr||l===Jr;if(c||u){let f=t.get(a),h=f!==void 0?f.texture.pmremVersion:0;if(a.isRenderTargetTexture&&a.pmremVersion!==h)return e===null&&(e=new ul(i)),f=c?e.fromEquirectangular(a,f):e.fromCubemap(a,f),f.texture.pmremVersion=a.pmremVersion,t.set(a,f),f.texture;if(f!==void 0)return f.texture;{let p=a.image;return c&&p&&p.height>0||u&&p&&s(p)?(e===null&&(e=new ul(i)),f=c?e.fromEquirectangular(a):e.fromCubemap(a),f.texture.pmremVersion=a.pmremVersion,t.set(a,f),a.addEventListener("dispose",r),f.texture):null}}}return a}function s(a){let l=0,c=6;for(let u=0;u<c;u++)a[u]!==void 0&&l++;return l===c}function r(a){let l=a.target;l.removeEventListener("dispose",r);let c=t.get(l);c!==void 0&&(t.delete(l),c.dispose())}function o(){t=new WeakMap,e!==null&&(e.dispose(),e=null)}return{get:n,dispose:o}}function OM(i){let t={};function e(n){if(t[n]!==void 0)return t[n];let s;switch(n){case"WEBGL_depth_texture":s=i.getExtension("WEBGL_depth_texture")||i.getExtension("MOZ_WEBGL_depth_texture")||i.getExtension("WEBKIT_WEBGL_depth_texture");break;case"EXT_texture_filter_anisotropic":s=i.getExtension("EXT_texture_filter_anisotropic")||i.getExtension("MOZ_EXT_texture_filter_anisotropic")||i.getExtension("WEBKIT_EXT_texture_filter_anisotropic");break;case"WEBGL_compressed_texture_s3tc":s=i.getExtension("WEBGL_compressed_texture_s3tc")||i.getExtension("MOZ_WEBGL_compressed_texture_s3tc")||i.getExtension("WEBKIT_WEBGL_compressed_texture_s3tc");break;case"WEBGL_compressed_texture_pvrtc":s=i.getExtension("WEBGL_compressed_texture_pvrtc")||i.getExtension("WEBKIT_WEBGL_compressed_texture_pvrtc");break;default:s=i.getExtension(n)}return t[n]=s,s}return{has:function(n){return e(n)!==null},init:function(){e("EXT_color_buffer_float"),e("WEBGL_clip_cull_distance"),e("OES_texture_float_linear"),e("EXT_color_buffer_half_float"),e("WEBGL_multisampled_render_to_texture"),e("WEBGL_render_shared_exponent")},get:function(n){let s=e(n);return s===null&&Do("THREE.WebGLRenderer: "+n+" extension not supported."),s}}}function FM(i,t,e,n){let s={},r=new WeakMap;function o(f){let h=f.target;h.index!==null&&t.remove(h.index);for(let _ in h.attributes)t.remove(h.attributes[_]);for(let _ in h.morphAttributes){let g=h.morphAttributes[_];for(let m=0,d=g.length;m<d;m++)t.remove(g[m])}h.removeEventListener("dispose",o),delete s[h.id];let p=r.get(h);p&&(t.remove(p),r.delete(h)),n.releaseStatesOfGeometry(h),h.isInstancedBufferGeometry===!0&&delete h._maxInstanceCount,e.memory.geometries--}function a(f,h){return s[h.id]===!0||(h.addEventListener("dispose",o),s[h.id]=!0,e.memory.geometries++),h}function l(f){let h=f.attributes;for(let _ in h)t.update(h[_],i.ARRAY_BUFFER);let p=f.morphAttributes;for(let _ in p){let g=p[_];for(let m=0,d=g.length;m<d;m++)t.update(g[m],i.ARRAY_BUFFER)}}function c(f){let h=[],p=f.index,_=f.attributes.position,g=0;if(p!==null){let S=p.array;g=p.version;for(let v=0,y=S.length;v<y;v+=3){let I=S[v+0],C=S[v+1],R=S[v+2];h.push(I,C,C,R,R,I)}}else if(_!==void 0){let S=_.array;g=_.version;for(let v=0,y=S.length/3-1;v<y;v+=3){let I=v+0,C=v+1,R=v+2;h.push(I,C,C,R,R,I)}}else return;let m=new(Rm(h)?ol:rl)(h,1);m.version=g;let d=r.get(f);d&&t.remove(d),r.set(f,m)}function u(f){let h=r.get(f);if(h){let p=f.index;p!==null&&h.version<p.version&&c(f)}else c(f);return r.get(f)}return{get:a,update:l,getWireframeAttribute:u}}function BM(i,t,e){let n;function s(h){n=h}let r,o;function a(h){r=h.type,o=h.bytesPerElement}function l(h,p){i.drawElements(n,p,r,h*o),e.update(p,n,1)}function c(h,p,_){_!==0&&(i.drawElementsInstanced(n,p,r,h*o,_),e.update(p,n,_))}function u(h,p,_){if(_===0)return;t.get("WEBGL_multi_draw").multiDrawElementsWEBGL(n,p,0,r,h,0,_);let m=0;for(let d=0;d<_;d++)m+=p[d];e.update(m,n,1)}function f(h,p,_,g){if(_===0)return;let m=t.get("WEBGL_multi_draw");if(m===null)for(let d=0;d<h.length;d++)c(h[d]/o,p[d],g[d]);else{m.multiDrawElementsInstancedWEBGL(n,p,0,r,h,0,g,0,_);let d=0;for(let S=0;S<_;S++)d+=p[S]*g[S];e.update(d,n,1)}}this.setMode=s,this.setIndex=a,this.render=l,this.renderInstances=c,this.renderMultiDraw=u,this.renderMultiDrawInstances=f}function kM(i){let t={geometries:0,textures:0},e={frame:0,calls:0,triangles:0,points:0,lines:0};function n(r,o,a){switch(e.calls++,o){case i.TRIANGLES:e.triangles+=a*(r/3);break;case i.LINES:e.lines+=a*(r/2);break;case i.LINE_STRIP:e.lines+=a*(r-1);break;case i.LINE_LOOP:e.lines+=a*r;break;case i.POINTS:e.points+=a*r;break;default:console.error("THREE.WebGLInfo: Unknown draw mode:",o);break}}function s(){e.calls=0,e.triangles=0,e.points=0,e.lines=0}return{memory:t,render:e,programs:null,autoReset:!0,reset:s,update:n}}function zM(i,t,e){let n=new WeakMap,s=new He;function r(o,a,l){let c=o.morphTargetInfluences,u=a.morphAttributes.position||a.morphAttributes.normal||a.morphAttributes.color,f=u!==void 0?u.length:0,h=n.get(a);if(h===void 0||h.count!==f){let E=function(){R.dispose(),n.delete(a),a.removeEventListener("dispose",E)};h!==void 0&&h.texture.dispose();let p=a.morphAttributes.position!==void 0,_=a.morphAttributes.normal!==void 0,g=a.morphAttributes.color!==void 0,m=a.morphAttributes.position||[],d=a.morphAttributes.normal||[],S=a.morphAttributes.color||[],v=0;p===!0&&(v=1),_===!0&&(v=2),g===!0&&(v=3);let y=a.attributes.position.count*v,I=1;y>t.maxTextureSize&&(I=Math.ceil(y/t.maxTextureSize),y=t.maxTextureSize);let C=new Float32Array(y*I*4*f),R=new il(C,y,I,f);R.type=$i,R.needsUpdate=!0;let L=v*4;for(let b=0;b<f;b++){let A=m[b],O=d[b],F=S[b],G=y*I*4*b;for(let $=0;$<A.count;$++){let W=$*L;p===!0&&(s.fromBufferAttribute(A,$),C[G+W+0]=s.x,C[G+W+1]=s.y,C[G+W+2]=s.z,C[G+W+3]=0),_===!0&&(s.fromBufferAttribute(O,$),C[G+W+4]=s.x,C[G+W+5]=s.y,C[G+W+6]=s.z,C[G+W+7]=0),g===!0&&(s.fromBufferAttribute(F,$),C[G+W+8]=s.x,C[G+W+9]=s.y,C[G+W+10]=s.z,C[G+W+11]=F.itemSize===4?s.w:1)}}h={count:f,texture:R,size:new se(y,I)},n.set(a,h),a.addEventListener("dispose",E)}if(o.isInstancedMesh===!0&&o.morphTexture!==null)l.getUniforms().setValue(i,"morphTexture",o.morphTexture,e);else{let p=0;for(let g=0;g<c.length;g++)p+=c[g];let _=a.morphTargetsRelative?1:1-p;l.getUniforms().setValue(i,"morphTargetBaseInfluence",_),l.getUniforms().setValue(i,"morphTargetInfluences",c)}l.getUniforms().setValue(i,"morphTargetsTexture",h.texture,e),l.getUniforms().setValue(i,"morphTargetsTextureSize",h.size)}return{update:r}}function VM(i,t,e,n){let s=new WeakMap;function r(l){let c=n.render.frame,u=l.geometry,f=t.get(l,u);if(s.get(f)!==c&&(t.update(f),s.set(f,c)),l.isInstancedMesh&&(l.hasEventListener("dispose",a)===!1&&l.addEventListener("dispose",a),s.get(l)!==c&&(e.update(l.instanceMatrix,i.ARRAY_BUFFER),l.instanceColor!==null&&e.update(l.instanceColor,i.ARRAY_BUFFER),s.set(l,c))),l.isSkinnedMesh){let h=l.skeleton;s.get(h)!==c&&(h.update(),s.set(h,c))}return f}function o(){s=new WeakMap}function a(l){let c=l.target;c.removeEventListener("dispose",a),e.remove(c.instanceMatrix),c.instanceColor!==null&&e.remove(c.instanceColor)}return{update:r,dispose:o}}var fl=class extends Fn{constructor(t,e,n,s,r,o,a,l,c,u=Xr){if(u!==Xr&&u!==jr)throw new Error("DepthTexture format must be either THREE.DepthFormat or THREE.DepthStencilFormat");n===void 0&&u===Xr&&(n=Ks),n===void 0&&u===jr&&(n=Kr),super(null,s,r,o,a,l,u,n,c),this.isDepthTexture=!0,this.image={width:t,height:e},this.magFilter=a!==void 0?a:xi,this.minFilter=l!==void 0?l:xi,this.flipY=!1,this.generateMipmaps=!1,this.compareFunction=null}copy(t){return super.copy(t),this.compareFunction=t.compareFunction,this}toJSON(t){let e=super.toJSON(t);return this.compareFunction!==null&&(e.compareFunction=this.compareFunction),e}},Dm=new Fn,Gp=new fl(1,1),Um=new il,Nm=new jh,Om=new ll,Wp=[],Xp=[],qp=new Float32Array(16),Yp=new Float32Array(9),$p=new Float32Array(4);function ao(i,t,e){let n=i[0];if(n<=0||n>0)return i;let s=t*e,r=Wp[s];if(r===void 0&&(r=new Float32Array(s),Wp[s]=r),t!==0){n.toArray(r,0);for(let o=1,a=0;o!==t;++o)a+=e,i[o].toArray(r,a)}return r}function en(i,t){if(i.length!==t.length)return!1;for(let e=0,n=i.length;e<n;e++)if(i[e]!==t[e])return!1;return!0}function nn(i,t){for(let e=0,n=t.length;e<n;e++)i[e]=t[e]}function Tl(i,t){let e=Xp[t];e===void 0&&(e=new Int32Array(t),Xp[t]=e);for(let n=0;n!==t;++n)e[n]=i.allocateTextureUnit();return e}function HM(i,t){let e=this.cache;e[0]!==t&&(i.uniform1f(this.addr,t),e[0]=t)}function GM(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2f(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(en(e,t))return;i.uniform2fv(this.addr,t),nn(e,t)}}function WM(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3f(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else if(t.r!==void 0)(e[0]!==t.r||e[1]!==t.g||e[2]!==t.b)&&(i.uniform3f(this.addr,t.r,t.g,t.b),e[0]=t.r,e[1]=t.g,e[2]=t.b);else{if(en(e,t))return;i.uniform3fv(this.addr,t),nn(e,t)}}function XM(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4f(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(en(e,t))return;i.uniform4fv(this.addr,t),nn(e,t)}}function qM(i,t){let e=this.cache,n=t.elements;if(n===void 0){if(en(e,t))return;i.uniformMatrix2fv(this.addr,!1,t),nn(e,t)}else{if(en(e,n))return;$p.set(n),i.uniformMatrix2fv(this.addr,!1,$p),nn(e,n)}}function YM(i,t){let e=this.cache,n=t.elements;if(n===void 0){if(en(e,t))return;i.uniformMatrix3fv(this.addr,!1,t),nn(e,t)}else{if(en(e,n))return;Yp.set(n),i.uniformMatrix3fv(this.addr,!1,Yp),nn(e,n)}}function $M(i,t){let e=this.cache,n=t.elements;if(n===void 0){if(en(e,t))return;i.uniformMatrix4fv(this.addr,!1,t),nn(e,t)}else{if(en(e,n))return;qp.set(n),i.uniformMatrix4fv(this.addr,!1,qp),nn(e,n)}}function ZM(i,t){let e=this.cache;e[0]!==t&&(i.uniform1i(this.addr,t),e[0]=t)}function JM(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2i(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(en(e,t))return;i.uniform2iv(this.addr,t),nn(e,t)}}function KM(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3i(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else{if(en(e,t))return;i.uniform3iv(this.addr,t),nn(e,t)}}function jM(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4i(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(en(e,t))return;i.uniform4iv(this.addr,t),nn(e,t)}}function QM(i,t){let e=this.cache;e[0]!==t&&(i.uniform1ui(this.addr,t),e[0]=t)}function tS(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y)&&(i.uniform2ui(this.addr,t.x,t.y),e[0]=t.x,e[1]=t.y);else{if(en(e,t))return;i.uniform2uiv(this.addr,t),nn(e,t)}}function eS(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z)&&(i.uniform3ui(this.addr,t.x,t.y,t.z),e[0]=t.x,e[1]=t.y,e[2]=t.z);else{if(en(e,t))return;i.uniform3uiv(this.addr,t),nn(e,t)}}function nS(i,t){let e=this.cache;if(t.x!==void 0)(e[0]!==t.x||e[1]!==t.y||e[2]!==t.z||e[3]!==t.w)&&(i.uniform4ui(this.addr,t.x,t.y,t.z,t.w),e[0]=t.x,e[1]=t.y,e[2]=t.z,e[3]=t.w);else{if(en(e,t))return;i.uniform4uiv(this.addr,t),nn(e,t)}}function iS(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s);let r;this.type===i.SAMPLER_2D_SHADOW?(Gp.compareFunction=Am,r=Gp):r=Dm,e.setTexture2D(t||r,s)}function sS(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),e.setTexture3D(t||Nm,s)}function rS(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),e.setTextureCube(t||Om,s)}function oS(i,t,e){let n=this.cache,s=e.allocateTextureUnit();n[0]!==s&&(i.uniform1i(this.addr,s),n[0]=s),e.setTexture2DArray(t||Um,s)}function aS(i){switch(i){case 5126:return HM;case 35664:return GM;case 35665:return WM;case 35666:return XM;case 35674:return qM;case 35675:return YM;case 35676:return $M;case 5124:case 35670:return ZM;case 35667:case 35671:return JM;case 35668:case 35672:return KM;case 35669:case 35673:return jM;case 5125:return QM;case 36294:return tS;case 36295:return eS;case 36296:return nS;case 35678:case 36198:case 36298:case 36306:case 35682:return iS;case 35679:case 36299:case 36307:return sS;case 35680:case 36300:case 36308:case 36293:return rS;case 36289:case 36303:case 36311:case 36292:return oS}}function lS(i,t){i.uniform1fv(this.addr,t)}function cS(i,t){let e=ao(t,this.size,2);i.uniform2fv(this.addr,e)}function hS(i,t){let e=ao(t,this.size,3);i.uniform3fv(this.addr,e)}function uS(i,t){let e=ao(t,this.size,4);i.uniform4fv(this.addr,e)}function fS(i,t){let e=ao(t,this.size,4);i.uniformMatrix2fv(this.addr,!1,e)}function dS(i,t){let e=ao(t,this.size,9);i.uniformMatrix3fv(this.addr,!1,e)}function pS(i,t){let e=ao(t,this.size,16);i.uniformMatrix4fv(this.addr,!1,e)}function mS(i,t){i.uniform1iv(this.addr,t)}function gS(i,t){i.uniform2iv(this.addr,t)}function _S(i,t){i.uniform3iv(this.addr,t)}function xS(i,t){i.uniform4iv(this.addr,t)}function yS(i,t){i.uniform1uiv(this.addr,t)}function vS(i,t){i.uniform2uiv(this.addr,t)}function MS(i,t){i.uniform3uiv(this.addr,t)}function SS(i,t){i.uniform4uiv(this.addr,t)}function bS(i,t,e){let n=this.cache,s=t.length,r=Tl(e,s);en(n,r)||(i.uniform1iv(this.addr,r),nn(n,r));for(let o=0;o!==s;++o)e.setTexture2D(t[o]||Dm,r[o])}function wS(i,t,e){let n=this.cache,s=t.length,r=Tl(e,s);en(n,r)||(i.uniform1iv(this.addr,r),nn(n,r));for(let o=0;o!==s;++o)e.setTexture3D(t[o]||Nm,r[o])}function ES(i,t,e){let n=this.cache,s=t.length,r=Tl(e,s);en(n,r)||(i.uniform1iv(this.addr,r),nn(n,r));for(let o=0;o!==s;++o)e.setTextureCube(t[o]||Om,r[o])}function TS(i,t,e){let n=this.cache,s=t.length,r=Tl(e,s);en(n,r)||(i.uniform1iv(this.addr,r),nn(n,r));for(let o=0;o!==s;++o)e.setTexture2DArray(t[o]||Um,r[o])}function AS(i){switch(i){case 5126:return lS;case 35664:return cS;case 35665:return hS;case 35666:return uS;case 35674:return fS;case 35675:return dS;case 35676:return pS;case 5124:case 35670:return mS;case 35667:case 35671:return gS;case 35668:case 35672:return _S;case 35669:case 35673:return xS;case 5125:return yS;case 36294:return vS;case 36295:return MS;case 36296:return SS;case 35678:case 36198:case 36298:case 36306:case 35682:return bS;case 35679:case 36299:case 36307:return wS;case 35680:case 36300:case 36308:case 36293:return ES;case 36289:case 36303:case 36311:case 36292:return TS}}var eu=class{constructor(t,e,n){this.id=t,this.addr=n,this.cache=[],this.type=e.type,this.setValue=aS(e.type)}},nu=class{constructor(t,e,n){this.id=t,this.addr=n,this.cache=[],this.type=e.type,this.size=e.size,this.setValue=AS(e.type)}},iu=class{constructor(t){this.id=t,this.seq=[],this.map={}}setValue(t,e,n){let s=this.seq;for(let r=0,o=s.length;r!==o;++r){let a=s[r];a.setValue(t,e[a.id],n)}}},ah=/(\w+)(\])?(\[|\.)?/g;function Zp(i,t){i.seq.push(t),i.map[t.id]=t}function CS(i,t,e){let n=i.name,s=n.length;for(ah.lastIndex=0;;){let r=ah.exec(n),o=ah.lastIndex,a=r[1],l=r[2]==="]",c=r[3];if(l&&(a=a|0),c===void 0||c==="["&&o+2===s){Zp(e,c===void 0?new eu(a,i,t):new nu(a,i,t));break}else{let f=e.map[a];f===void 0&&(f=new iu(a),Zp(e,f)),e=f}}}var Yr=class{constructor(t,e){this.seq=[],this.map={};let n=t.getProgramParameter(e,t.ACTIVE_UNIFORMS);for(let s=0;s<n;++s){let r=t.getActiveUniform(e,s),o=t.getUniformLocation(e,r.name);CS(r,o,this)}}setValue(t,e,n,s){let r=this.map[e];r!==void 0&&r.setValue(t,n,s)}setOptional(t,e,n){let s=e[n];s!==void 0&&this.setValue(t,n,s)}static upload(t,e,n,s){for(let r=0,o=e.length;r!==o;++r){let a=e[r],l=n[a.id];l.needsUpdate!==!1&&a.setValue(t,l.value,s)}}static seqWithValue(t,e){let n=[];for(let s=0,r=t.length;s!==r;++s){let o=t[s];o.id in e&&n.push(o)}return n}};function Jp(i,t,e){let n=i.createShader(t);return i.shaderSource(n,e),i.compileShader(n),n}var RS=37297,PS=0;function IS(i,t){let e=i.split(`
`),n=[],s=Math.max(t-6,0),r=Math.min(t+6,e.length);for(let o=s;o<r;o++){let a=o+1;n.push(`${a===t?">":" "} ${a}: ${e[o]}`)}return n.join(`
`)}var Kp=new oe;function LS(i){ye._getMatrix(Kp,ye.workingColorSpace,i);let t=`mat3( ${Kp.elements.map(e=>e.toFixed(4))} )`;switch(ye.getTransfer(i)){case El:return[t,"LinearTransferOETF"];case Ce:return[t,"sRGBTransferOETF"];default:return console.warn("THREE.WebGLProgram: Unsupported color space: ",i),[t,"LinearTransferOETF"]}}function jp(i,t,e){let n=i.getShaderParameter(t,i.COMPILE_STATUS),s=i.getShaderInfoLog(t).trim();if(n&&s==="")return"";let r=/ERROR: 0:(\d+)/.exec(s);if(r){let o=parseInt(r[1]);return e.toUpperCase()+`

`+s+`

`+IS(i.getShaderSource(t),o)}else return s}function DS(i,t){let e=LS(t);return[`vec4 ${i}( vec4 value ) {`,`	return ${e[1]}( vec4( value.rgb * ${e[0]}, value.a ) );`,"}"].join(`
`)}function US(i,t){let e;switch(t){case W_:e="Linear";break;case X_:e="Reinhard";break;case q_:e="Cineon";break;case Y_:e="ACESFilmic";break;case Z_:e="AgX";break;case J_:e="Neutral";break;case $_:e="Custom";break;default:console.warn("THREE.WebGLProgram: Unsupported toneMapping:",t),e="Linear"}return"vec3 "+i+"( vec3 color ) { return "+e+"ToneMapping( color ); }"}var Wa=new Y;function NS(){ye.getLuminanceCoefficients(Wa);let i=Wa.x.toFixed(4),t=Wa.y.toFixed(4),e=Wa.z.toFixed(4);return["float luminance( const in vec3 rgb ) {",`	const vec3 weights = vec3( ${i}, ${t}, ${e} );`,"	return dot( weights, rgb );","}"].join(`
`)}function OS(i){return[i.extensionClipCullDistance?"#extension GL_ANGLE_clip_cull_distance : require":"",i.extensionMultiDraw?"#extension GL_ANGLE_multi_draw : require":""].filter(Uo).join(`
`)}function FS(i){let t=[];for(let e in i){let n=i[e];n!==!1&&t.push("#define "+e+" "+n)}return t.join(`
`)}function BS(i,t){let e={},n=i.getProgramParameter(t,i.ACTIVE_ATTRIBUTES);for(let s=0;s<n;s++){let r=i.getActiveAttrib(t,s),o=r.name,a=1;r.type===i.FLOAT_MAT2&&(a=2),r.type===i.FLOAT_MAT3&&(a=3),r.type===i.FLOAT_MAT4&&(a=4),e[o]={type:r.type,location:i.getAttribLocation(t,o),locationSize:a}}return e}function Uo(i){return i!==""}function Qp(i,t){let e=t.numSpotLightShadows+t.numSpotLightMaps-t.numSpotLightShadowsWithMaps;return i.replace(/NUM_DIR_LIGHTS/g,t.numDirLights).replace(/NUM_SPOT_LIGHTS/g,t.numSpotLights).replace(/NUM_SPOT_LIGHT_MAPS/g,t.numSpotLightMaps).replace(/NUM_SPOT_LIGHT_COORDS/g,e).replace(/NUM_RECT_AREA_LIGHTS/g,t.numRectAreaLights).replace(/NUM_POINT_LIGHTS/g,t.numPointLights).replace(/NUM_HEMI_LIGHTS/g,t.numHemiLights).replace(/NUM_DIR_LIGHT_SHADOWS/g,t.numDirLightShadows).replace(/NUM_SPOT_LIGHT_SHADOWS_WITH_MAPS/g,t.numSpotLightShadowsWithMaps).replace(/NUM_SPOT_LIGHT_SHADOWS/g,t.numSpotLightShadows).replace(/NUM_POINT_LIGHT_SHADOWS/g,t.numPointLightShadows)}function tm(i,t){return i.replace(/NUM_CLIPPING_PLANES/g,t.numClippingPlanes).replace(/UNION_CLIPPING_PLANES/g,t.numClippingPlanes-t.numClipIntersection)}var kS=/^[ \t]*#include +<([\w\d./]+)>/gm;function su(i){return i.replace(kS,VS)}var zS=new Map;function VS(i,t){let e=ae[t];if(e===void 0){let n=zS.get(t);if(n!==void 0)e=ae[n],console.warn('THREE.WebGLRenderer: Shader chunk "%s" has been deprecated. Use "%s" instead.',t,n);else throw new Error("Can not resolve #include <"+t+">")}return su(e)}var HS=/#pragma unroll_loop_start\s+for\s*\(\s*int\s+i\s*=\s*(\d+)\s*;\s*i\s*<\s*(\d+)\s*;\s*i\s*\+\+\s*\)\s*{([\s\S]+?)}\s+#pragma unroll_loop_end/g;function em(i){return i.replace(HS,GS)}function GS(i,t,e,n){let s="";for(let r=parseInt(t);r<parseInt(e);r++)s+=n.replace(/\[\s*i\s*\]/g,"[ "+r+" ]").replace(/UNROLLED_LOOP_INDEX/g,r);return s}function nm(i){let t=`precision ${i.precision} float;
	precision ${i.precision} int;
	precision ${i.precision} sampler2D;
	precision ${i.precision} samplerCube;
	precision ${i.precision} sampler3D;
	precision ${i.precision} sampler2DArray;
	precision ${i.precision} sampler2DShadow;
	precision ${i.precision} samplerCubeShadow;
	precision ${i.precision} sampler2DArrayShadow;
	precision ${i.precision} isampler2D;
	precision ${i.precision} isampler3D;
	precision ${i.precision} isamplerCube;
	precision ${i.precision} isampler2DArray;
	precision ${i.precision} usampler2D;
	precision ${i.precision} usampler3D;
	precision ${i.precision} usamplerCube;
	precision ${i.precision} usampler2DArray;
	`;return i.precision==="highp"?t+=`
#define HIGH_PRECISION`:i.precision==="mediump"?t+=`
#define MEDIUM_PRECISION`:i.precision==="lowp"&&(t+=`
#define LOW_PRECISION`),t}function WS(i){let t="SHADOWMAP_TYPE_BASIC";return i.shadowMapType===dm?t="SHADOWMAP_TYPE_PCF":i.shadowMapType===b_?t="SHADOWMAP_TYPE_PCF_SOFT":i.shadowMapType===Yi&&(t="SHADOWMAP_TYPE_VSM"),t}function XS(i){let t="ENVMAP_TYPE_CUBE";if(i.envMap)switch(i.envMapMode){case Zr:case Jr:t="ENVMAP_TYPE_CUBE";break;case wl:t="ENVMAP_TYPE_CUBE_UV";break}return t}function qS(i){let t="ENVMAP_MODE_REFLECTION";if(i.envMap)switch(i.envMapMode){case Jr:t="ENVMAP_MODE_REFRACTION";break}return t}function YS(i){let t="ENVMAP_BLENDING_NONE";if(i.envMap)switch(i.combine){case pm:t="ENVMAP_BLENDING_MULTIPLY";break;case H_:t="ENVMAP_BLENDING_MIX";break;case G_:t="ENVMAP_BLENDING_ADD";break}return t}function $S(i){let t=i.envMapCubeUVHeight;if(t===null)return null;let e=Math.log2(t)-2,n=1/t;return{texelWidth:1/(3*Math.max(Math.pow(2,e),7*16)),texelHeight:n,maxMip:e}}function ZS(i,t,e,n){let s=i.getContext(),r=e.defines,o=e.vertexShader,a=e.fragmentShader,l=WS(e),c=XS(e),u=qS(e),f=YS(e),h=$S(e),p=OS(e),_=FS(r),g=s.createProgram(),m,d,S=e.glslVersion?"#version "+e.glslVersion+`
`:"";e.isRawShaderMaterial?(m=["#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,_].filter(Uo).join(`
`),m.length>0&&(m+=`
`),d=["#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,_].filter(Uo).join(`
`),d.length>0&&(d+=`
`)):(m=[nm(e),"#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,_,e.extensionClipCullDistance?"#define USE_CLIP_DISTANCE":"",e.batching?"#define USE_BATCHING":"",e.batchingColor?"#define USE_BATCHING_COLOR":"",e.instancing?"#define USE_INSTANCING":"",e.instancingColor?"#define USE_INSTANCING_COLOR":"",e.instancingMorph?"#define USE_INSTANCING_MORPH":"",e.useFog&&e.fog?"#define USE_FOG":"",e.useFog&&e.fogExp2?"#define FOG_EXP2":"",e.map?"#define USE_MAP":"",e.envMap?"#define USE_ENVMAP":"",e.envMap?"#define "+u:"",e.lightMap?"#define USE_LIGHTMAP":"",e.aoMap?"#define USE_AOMAP":"",e.bumpMap?"#define USE_BUMPMAP":"",e.normalMap?"#define USE_NORMALMAP":"",e.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",e.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",e.displacementMap?"#define USE_DISPLACEMENTMAP":"",e.emissiveMap?"#define USE_EMISSIVEMAP":"",e.anisotropy?"#define USE_ANISOTROPY":"",e.anisotropyMap?"#define USE_ANISOTROPYMAP":"",e.clearcoatMap?"#define USE_CLEARCOATMAP":"",e.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",e.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",e.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",e.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",e.specularMap?"#define USE_SPECULARMAP":"",e.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",e.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",e.roughnessMap?"#define USE_ROUGHNESSMAP":"",e.metalnessMap?"#define USE_METALNESSMAP":"",e.alphaMap?"#define USE_ALPHAMAP":"",e.alphaHash?"#define USE_ALPHAHASH":"",e.transmission?"#define USE_TRANSMISSION":"",e.transmissionMap?"#define USE_TRANSMISSIONMAP":"",e.thicknessMap?"#define USE_THICKNESSMAP":"",e.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",e.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",e.mapUv?"#define MAP_UV "+e.mapUv:"",e.alphaMapUv?"#define ALPHAMAP_UV "+e.alphaMapUv:"",e.lightMapUv?"#define LIGHTMAP_UV "+e.lightMapUv:"",e.aoMapUv?"#define AOMAP_UV "+e.aoMapUv:"",e.emissiveMapUv?"#define EMISSIVEMAP_UV "+e.emissiveMapUv:"",e.bumpMapUv?"#define BUMPMAP_UV "+e.bumpMapUv:"",e.normalMapUv?"#define NORMALMAP_UV "+e.normalMapUv:"",e.displacementMapUv?"#define DISPLACEMENTMAP_UV "+e.displacementMapUv:"",e.metalnessMapUv?"#define METALNESSMAP_UV "+e.metalnessMapUv:"",e.roughnessMapUv?"#define ROUGHNESSMAP_UV "+e.roughnessMapUv:"",e.anisotropyMapUv?"#define ANISOTROPYMAP_UV "+e.anisotropyMapUv:"",e.clearcoatMapUv?"#define CLEARCOATMAP_UV "+e.clearcoatMapUv:"",e.clearcoatNormalMapUv?"#define CLEARCOAT_NORMALMAP_UV "+e.clearcoatNormalMapUv:"",e.clearcoatRoughnessMapUv?"#define CLEARCOAT_ROUGHNESSMAP_UV "+e.clearcoatRoughnessMapUv:"",e.iridescenceMapUv?"#define IRIDESCENCEMAP_UV "+e.iridescenceMapUv:"",e.iridescenceThicknessMapUv?"#define IRIDESCENCE_THICKNESSMAP_UV "+e.iridescenceThicknessMapUv:"",e.sheenColorMapUv?"#define SHEEN_COLORMAP_UV "+e.sheenColorMapUv:"",e.sheenRoughnessMapUv?"#define SHEEN_ROUGHNESSMAP_UV "+e.sheenRoughnessMapUv:"",e.specularMapUv?"#define SPECULARMAP_UV "+e.specularMapUv:"",e.specularColorMapUv?"#define SPECULAR_COLORMAP_UV "+e.specularColorMapUv:"",e.specularIntensityMapUv?"#define SPECULAR_INTENSITYMAP_UV "+e.specularIntensityMapUv:"",e.transmissionMapUv?"#define TRANSMISSIONMAP_UV "+e.transmissionMapUv:"",e.thicknessMapUv?"#define THICKNESSMAP_UV "+e.thicknessMapUv:"",e.vertexTangents&&e.flatShading===!1?"#define USE_TANGENT":"",e.vertexColors?"#define USE_COLOR":"",e.vertexAlphas?"#define USE_COLOR_ALPHA":"",e.vertexUv1s?"#define USE_UV1":"",e.vertexUv2s?"#define USE_UV2":"",e.vertexUv3s?"#define USE_UV3":"",e.pointsUvs?"#define USE_POINTS_UV":"",e.flatShading?"#define FLAT_SHADED":"",e.skinning?"#define USE_SKINNING":"",e.morphTargets?"#define USE_MORPHTARGETS":"",e.morphNormals&&e.flatShading===!1?"#define USE_MORPHNORMALS":"",e.morphColors?"#define USE_MORPHCOLORS":"",e.morphTargetsCount>0?"#define MORPHTARGETS_TEXTURE_STRIDE "+e.morphTextureStride:"",e.morphTargetsCount>0?"#define MORPHTARGETS_COUNT "+e.morphTargetsCount:"",e.doubleSided?"#define DOUBLE_SIDED":"",e.flipSided?"#define FLIP_SIDED":"",e.shadowMapEnabled?"#define USE_SHADOWMAP":"",e.shadowMapEnabled?"#define "+l:"",e.sizeAttenuation?"#define USE_SIZEATTENUATION":"",e.numLightProbes>0?"#define USE_LIGHT_PROBES":"",e.logarithmicDepthBuffer?"#define USE_LOGDEPTHBUF":"",e.reverseDepthBuffer?"#define USE_REVERSEDEPTHBUF":"","uniform mat4 modelMatrix;","uniform mat4 modelViewMatrix;","uniform mat4 projectionMatrix;","uniform mat4 viewMatrix;","uniform mat3 normalMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;","#ifdef USE_INSTANCING","	attribute mat4 instanceMatrix;","#endif","#ifdef USE_INSTANCING_COLOR","	attribute vec3 instanceColor;","#endif","#ifdef USE_INSTANCING_MORPH","	uniform sampler2D morphTexture;","#endif","attribute vec3 position;","attribute vec3 normal;","attribute vec2 uv;","#ifdef USE_UV1","	attribute vec2 uv1;","#endif","#ifdef USE_UV2","	attribute vec2 uv2;","#endif","#ifdef USE_UV3","	attribute vec2 uv3;","#endif","#ifdef USE_TANGENT","	attribute vec4 tangent;","#endif","#if defined( USE_COLOR_ALPHA )","	attribute vec4 color;","#elif defined( USE_COLOR )","	attribute vec3 color;","#endif","#ifdef USE_SKINNING","	attribute vec4 skinIndex;","	attribute vec4 skinWeight;","#endif",`
`].filter(Uo).join(`
`),d=[nm(e),"#define SHADER_TYPE "+e.shaderType,"#define SHADER_NAME "+e.shaderName,_,e.useFog&&e.fog?"#define USE_FOG":"",e.useFog&&e.fogExp2?"#define FOG_EXP2":"",e.alphaToCoverage?"#define ALPHA_TO_COVERAGE":"",e.map?"#define USE_MAP":"",e.matcap?"#define USE_MATCAP":"",e.envMap?"#define USE_ENVMAP":"",e.envMap?"#define "+c:"",e.envMap?"#define "+u:"",e.envMap?"#define "+f:"",h?"#define CUBEUV_TEXEL_WIDTH "+h.texelWidth:"",h?"#define CUBEUV_TEXEL_HEIGHT "+h.texelHeight:"",h?"#define CUBEUV_MAX_MIP "+h.maxMip+".0":"",e.lightMap?"#define USE_LIGHTMAP":"",e.aoMap?"#define USE_AOMAP":"",e.bumpMap?"#define USE_BUMPMAP":"",e.normalMap?"#define USE_NORMALMAP":"",e.normalMapObjectSpace?"#define USE_NORMALMAP_OBJECTSPACE":"",e.normalMapTangentSpace?"#define USE_NORMALMAP_TANGENTSPACE":"",e.emissiveMap?"#define USE_EMISSIVEMAP":"",e.anisotropy?"#define USE_ANISOTROPY":"",e.anisotropyMap?"#define USE_ANISOTROPYMAP":"",e.clearcoat?"#define USE_CLEARCOAT":"",e.clearcoatMap?"#define USE_CLEARCOATMAP":"",e.clearcoatRoughnessMap?"#define USE_CLEARCOAT_ROUGHNESSMAP":"",e.clearcoatNormalMap?"#define USE_CLEARCOAT_NORMALMAP":"",e.dispersion?"#define USE_DISPERSION":"",e.iridescence?"#define USE_IRIDESCENCE":"",e.iridescenceMap?"#define USE_IRIDESCENCEMAP":"",e.iridescenceThicknessMap?"#define USE_IRIDESCENCE_THICKNESSMAP":"",e.specularMap?"#define USE_SPECULARMAP":"",e.specularColorMap?"#define USE_SPECULAR_COLORMAP":"",e.specularIntensityMap?"#define USE_SPECULAR_INTENSITYMAP":"",e.roughnessMap?"#define USE_ROUGHNESSMAP":"",e.metalnessMap?"#define USE_METALNESSMAP":"",e.alphaMap?"#define USE_ALPHAMAP":"",e.alphaTest?"#define USE_ALPHATEST":"",e.alphaHash?"#define USE_ALPHAHASH":"",e.sheen?"#define USE_SHEEN":"",e.sheenColorMap?"#define USE_SHEEN_COLORMAP":"",e.sheenRoughnessMap?"#define USE_SHEEN_ROUGHNESSMAP":"",e.transmission?"#define USE_TRANSMISSION":"",e.transmissionMap?"#define USE_TRANSMISSIONMAP":"",e.thicknessMap?"#define USE_THICKNESSMAP":"",e.vertexTangents&&e.flatShading===!1?"#define USE_TANGENT":"",e.vertexColors||e.instancingColor||e.batchingColor?"#define USE_COLOR":"",e.vertexAlphas?"#define USE_COLOR_ALPHA":"",e.vertexUv1s?"#define USE_UV1":"",e.vertexUv2s?"#define USE_UV2":"",e.vertexUv3s?"#define USE_UV3":"",e.pointsUvs?"#define USE_POINTS_UV":"",e.gradientMap?"#define USE_GRADIENTMAP":"",e.flatShading?"#define FLAT_SHADED":"",e.doubleSided?"#define DOUBLE_SIDED":"",e.flipSided?"#define FLIP_SIDED":"",e.shadowMapEnabled?"#define USE_SHADOWMAP":"",e.shadowMapEnabled?"#define "+l:"",e.premultipliedAlpha?"#define PREMULTIPLIED_ALPHA":"",e.numLightProbes>0?"#define USE_LIGHT_PROBES":"",e.decodeVideoTexture?"#define DECODE_VIDEO_TEXTURE":"",e.decodeVideoTextureEmissive?"#define DECODE_VIDEO_TEXTURE_EMISSIVE":"",e.logarithmicDepthBuffer?"#define USE_LOGDEPTHBUF":"",e.reverseDepthBuffer?"#define USE_REVERSEDEPTHBUF":"","uniform mat4 viewMatrix;","uniform vec3 cameraPosition;","uniform bool isOrthographic;",e.toneMapping!==vs?"#define TONE_MAPPING":"",e.toneMapping!==vs?ae.tonemapping_pars_fragment:"",e.toneMapping!==vs?US("toneMapping",e.toneMapping):"",e.dithering?"#define DITHERING":"",e.opaque?"#define OPAQUE":"",ae.colorspace_pars_fragment,DS("linearToOutputTexel",e.outputColorSpace),NS(),e.useDepthPacking?"#define DEPTH_PACKING "+e.depthPacking:"",`
`].filter(Uo).join(`
`)),o=su(o),o=Qp(o,e),o=tm(o,e),a=su(a),a=Qp(a,e),a=tm(a,e),o=em(o),a=em(a),e.isRawShaderMaterial!==!0&&(S=`#version 300 es
`,m=[p,"#define attribute in","#define varying out","#define texture2D texture"].join(`
`)+`
`+m,d=["#define varying in",e.glslVersion===mp?"":"layout(location = 0) out highp vec4 pc_fragColor;",e.glslVersion===mp?"":"#define gl_FragColor pc_fragColor","#define gl_FragDepthEXT gl_FragDepth","#define texture2D texture","#define textureCube texture","#define texture2DProj textureProj","#define texture2DLodEXT textureLod","#define texture2DProjLodEXT textureProjLod","#define textureCubeLodEXT textureLod","#define texture2DGradEXT textureGrad","#define texture2DProjGradEXT textureProjGrad","#define textureCubeGradEXT textureGrad"].join(`
`)+`
`+d);let v=S+m+o,y=S+d+a,I=Jp(s,s.VERTEX_SHADER,v),C=Jp(s,s.FRAGMENT_SHADER,y);s.attachShader(g,I),s.attachShader(g,C),e.index0AttributeName!==void 0?s.bindAttribLocation(g,0,e.index0AttributeName):e.morphTargets===!0&&s.bindAttribLocation(g,0,"position"),s.linkProgram(g);function R(A){if(i.debug.checkShaderErrors){let O=s.getProgramInfoLog(g).trim(),F=s.getShaderInfoLog(I).trim(),G=s.getShaderInfoLog(C).trim(),$=!0,W=!0;if(s.getProgramParameter(g,s.LINK_STATUS)===!1)if($=!1,typeof i.debug.onShaderError=="function")i.debug.onShaderError(s,g,I,C);else{let Z=jp(s,I,"vertex"),J=jp(s,C,"fragment");console.error("THREE.WebGLProgram: Shader Error "+s.getError()+" - VALIDATE_STATUS "+s.getProgramParameter(g,s.VALIDATE_STATUS)+`

Material Name: `+A.name+`
Material Type: `+A.type+`

Program Info Log: `+O+`
`+Z+`
`+J)}else O!==""?console.warn("THREE.WebGLProgram: Program Info Log:",O):(F===""||G==="")&&(W=!1);W&&(A.diagnostics={runnable:$,programLog:O,vertexShader:{log:F,prefix:m},fragmentShader:{log:G,prefix:d}})}s.deleteShader(I),s.deleteShader(C),L=new Yr(s,g),E=BS(s,g)}let L;this.getUniforms=function(){return L===void 0&&R(this),L};let E;this.getAttributes=function(){return E===void 0&&R(this),E};let b=e.rendererExtensionParallelShaderCompile===!1;return this.isReady=function(){return b===!1&&(b=s.getProgramParameter(g,RS)),b},this.destroy=function(){n.releaseStatesOfProgram(this),s.deleteProgram(g),this.program=void 0},this.type=e.shaderType,this.name=e.shaderName,this.id=PS++,this.cacheKey=t,this.usedTimes=1,this.program=g,this.vertexShader=I,this.fragmentShader=C,this}var JS=0,ru=class{constructor(){this.shaderCache=new Map,this.materialCache=new Map}update(t){let e=t.vertexShader,n=t.fragmentShader,s=this._getShaderStage(e),r=this._getShaderStage(n),o=this._getShaderCacheForMaterial(t);return o.has(s)===!1&&(o.add(s),s.usedTimes++),o.has(r)===!1&&(o.add(r),r.usedTimes++),this}remove(t){let e=this.materialCache.get(t);for(let n of e)n.usedTimes--,n.usedTimes===0&&this.shaderCache.delete(n.code);return this.materialCache.delete(t),this}getVertexShaderID(t){return this._getShaderStage(t.vertexShader).id}getFragmentShaderID(t){return this._getShaderStage(t.fragmentShader).id}dispose(){this.shaderCache.clear(),this.materialCache.clear()}_getShaderCacheForMaterial(t){let e=this.materialCache,n=e.get(t);return n===void 0&&(n=new Set,e.set(t,n)),n}_getShaderStage(t){let e=this.shaderCache,n=e.get(t);return n===void 0&&(n=new ou(t),e.set(t,n)),n}},ou=class{constructor(t){this.id=JS++,this.code=t,this.usedTimes=0}};function KS(i,t,e,n,s,r,o){let a=new sl,l=new ru,c=new Set,u=[],f=s.logarithmicDepthBuffer,h=s.vertexTextures,p=s.precision,_={MeshDepthMaterial:"depth",MeshDistanceMaterial:"distanceRGBA",MeshNormalMaterial:"normal",MeshBasicMaterial:"basic",MeshLambertMaterial:"lambert",MeshPhongMaterial:"phong",MeshToonMaterial:"toon",MeshStandardMaterial:"physical",MeshPhysicalMaterial:"physical",MeshMatcapMaterial:"matcap",LineBasicMaterial:"basic",LineDashedMaterial:"dashed",PointsMaterial:"points",ShadowMaterial:"shadow",SpriteMaterial:"sprite"};function g(E){return c.add(E),E===0?"uv":`uv${E}`}function m(E,b,A,O,F){let G=O.fog,$=F.geometry,W=E.isMeshStandardMaterial?O.environment:null,Z=(E.isMeshStandardMaterial?e:t).get(E.envMap||W),J=Z&&Z.mapping===wl?Z.image.height:null,ct=_[E.type];E.precision!==null&&(p=s.getMaxPrecision(E.precision),p!==E.precision&&console.warn("THREE.WebGLProgram.getParameters:",E.precision,"not supported, using",p,"instead."));let lt=$.morphAttributes.position||$.morphAttributes.normal||$.morphAttributes.color,_t=lt!==void 0?lt.length:0,dt=0;$.morphAttributes.position!==void 0&&(dt=1),$.morphAttributes.normal!==void 0&&(dt=2),$.morphAttributes.color!==void 0&&(dt=3);let Yt,Q,ht,Bt;if(ct){let ce=Pi[ct];Yt=ce.vertexShader,Q=ce.fragmentShader}else Yt=E.vertexShader,Q=E.fragmentShader,l.update(E),ht=l.getVertexShaderID(E),Bt=l.getFragmentShaderID(E);let pt=i.getRenderTarget(),zt=i.state.buffers.depth.getReversed(),j=F.isInstancedMesh===!0,st=F.isBatchedMesh===!0,It=!!E.map,yt=!!E.matcap,Zt=!!Z,N=!!E.aoMap,le=!!E.lightMap,Qt=!!E.bumpMap,$t=!!E.normalMap,Dt=!!E.displacementMap,me=!!E.emissiveMap,Tt=!!E.metalnessMap,P=!!E.roughnessMap,M=E.anisotropy>0,V=E.clearcoat>0,rt=E.dispersion>0,et=E.iridescence>0,it=E.sheen>0,kt=E.transmission>0,vt=M&&!!E.anisotropyMap,wt=V&&!!E.clearcoatMap,Kt=V&&!!E.clearcoatNormalMap,ut=V&&!!E.clearcoatRoughnessMap,Mt=et&&!!E.iridescenceMap,Wt=et&&!!E.iridescenceThicknessMap,qt=it&&!!E.sheenColorMap,At=it&&!!E.sheenRoughnessMap,re=!!E.specularMap,jt=!!E.specularColorMap,Me=!!E.specularIntensityMap,B=kt&&!!E.transmissionMap,St=kt&&!!E.thicknessMap,nt=!!E.gradientMap,at=!!E.alphaMap,Rt=E.alphaTest>0,Ct=!!E.alphaHash,ne=!!E.extensions,Fe=vs;E.toneMapped&&(pt===null||pt.isXRRenderTarget===!0)&&(Fe=i.toneMapping);let Ut={shaderID:ct,shaderType:E.type,shaderName:E.name,vertexShader:Yt,fragmentShader:Q,defines:E.defines,customVertexShaderID:ht,customFragmentShaderID:Bt,isRawShaderMaterial:E.isRawShaderMaterial===!0,glslVersion:E.glslVersion,precision:p,batching:st,batchingColor:st&&F._colorsTexture!==null,instancing:j,instancingColor:j&&F.instanceColor!==null,instancingMorph:j&&F.morphTexture!==null,supportsVertexTextures:h,outputColorSpace:pt===null?i.outputColorSpace:pt.isXRRenderTarget===!0?pt.texture.colorSpace:ro,alphaToCoverage:!!E.alphaToCoverage,map:It,matcap:yt,envMap:Zt,envMapMode:Zt&&Z.mapping,envMapCubeUVHeight:J,aoMap:N,lightMap:le,bumpMap:Qt,normalMap:$t,displacementMap:h&&Dt,emissiveMap:me,normalMapObjectSpace:$t&&E.normalMapType===tx,normalMapTangentSpace:$t&&E.normalMapType===Tm,metalnessMap:Tt,roughnessMap:P,anisotropy:M,anisotropyMap:vt,clearcoat:V,clearcoatMap:wt,clearcoatNormalMap:Kt,clearcoatRoughnessMap:ut,dispersion:rt,iridescence:et,iridescenceMap:Mt,iridescenceThicknessMap:Wt,sheen:it,sheenColorMap:qt,sheenRoughnessMap:At,specularMap:re,specularColorMap:jt,specularIntensityMap:Me,transmission:kt,transmissionMap:B,thicknessMap:St,gradientMap:nt,opaque:E.transparent===!1&&E.blending===Wr&&E.alphaToCoverage===!1,alphaMap:at,alphaTest:Rt,alphaHash:Ct,combine:E.combine,mapUv:It&&g(E.map.channel),aoMapUv:N&&g(E.aoMap.channel),lightMapUv:le&&g(E.lightMap.channel),bumpMapUv:Qt&&g(E.bumpMap.channel),normalMapUv:$t&&g(E.normalMap.channel),displacementMapUv:Dt&&g(E.displacementMap.channel),emissiveMapUv:me&&g(E.emissiveMap.channel),metalnessMapUv:Tt&&g(E.metalnessMap.channel),roughnessMapUv:P&&g(E.roughnessMap.channel),anisotropyMapUv:vt&&g(E.anisotropyMap.channel),clearcoatMapUv:wt&&g(E.clearcoatMap.channel),clearcoatNormalMapUv:Kt&&g(E.clearcoatNormalMap.channel),clearcoatRoughnessMapUv:ut&&g(E.clearcoatRoughnessMap.channel),iridescenceMapUv:Mt&&g(E.iridescenceMap.channel),iridescenceThicknessMapUv:Wt&&g(E.iridescenceThicknessMap.channel),sheenColorMapUv:qt&&g(E.sheenColorMap.channel),sheenRoughnessMapUv:At&&g(E.sheenRoughnessMap.channel),specularMapUv:re&&g(E.specularMap.channel),specularColorMapUv:jt&&g(E.specularColorMap.channel),specularIntensityMapUv:Me&&g(E.specularIntensityMap.channel),transmissionMapUv:B&&g(E.transmissionMap.channel),thicknessMapUv:St&&g(E.thicknessMap.channel),alphaMapUv:at&&g(E.alphaMap.channel),vertexTangents:!!$.attributes.tangent&&($t||M),vertexColors:E.vertexColors,vertexAlphas:E.vertexColors===!0&&!!$.attributes.color&&$.attributes.color.itemSize===4,pointsUvs:F.isPoints===!0&&!!$.attributes.uv&&(It||at),fog:!!G,useFog:E.fog===!0,fogExp2:!!G&&G.isFogExp2,flatShading:E.flatShading===!0,sizeAttenuation:E.sizeAttenuation===!0,logarithmicDepthBuffer:f,reverseDepthBuffer:zt,skinning:F.isSkinnedMesh===!0,morphTargets:$.morphAttributes.position!==void 0,morphNormals:$.morphAttributes.normal!==void 0,morphColors:$.morphAttributes.color!==void 0,morphTargetsCount:_t,morphTextureStride:dt,numDirLights:b.directional.length,numPointLights:b.point.length,numSpotLights:b.spot.length,numSpotLightMaps:b.spotLightMap.length,numRectAreaLights:b.rectArea.length,numHemiLights:b.hemi.length,numDirLightShadows:b.directionalShadowMap.length,numPointLightShadows:b.pointShadowMap.length,numSpotLightShadows:b.spotShadowMap.length,numSpotLightShadowsWithMaps:b.numSpotLightShadowsWithMaps,numLightProbes:b.numLightProbes,numClippingPlanes:o.numPlanes,numClipIntersection:o.numIntersection,dithering:E.dithering,shadowMapEnabled:i.shadowMap.enabled&&A.length>0,shadowMapType:i.shadowMap.type,toneMapping:Fe,decodeVideoTexture:It&&E.map.isVideoTexture===!0&&ye.getTransfer(E.map.colorSpace)===Ce,decodeVideoTextureEmissive:me&&E.emissiveMap.isVideoTexture===!0&&ye.getTransfer(E.emissiveMap.colorSpace)===Ce,premultipliedAlpha:E.premultipliedAlpha,doubleSided:E.side===ii,flipSided:E.side===Nn,useDepthPacking:E.depthPacking>=0,depthPacking:E.depthPacking||0,index0AttributeName:E.index0AttributeName,extensionClipCullDistance:ne&&E.extensions.clipCullDistance===!0&&n.has("WEBGL_clip_cull_distance"),extensionMultiDraw:(ne&&E.extensions.multiDraw===!0||st)&&n.has("WEBGL_multi_draw"),rendererExtensionParallelShaderCompile:n.has("KHR_parallel_shader_compile"),customProgramCacheKey:E.customProgramCacheKey()};return Ut.vertexUv1s=c.has(1),Ut.vertexUv2s=c.has(2),Ut.vertexUv3s=c.has(3),c.clear(),Ut}function d(E){let b=[];if(E.shaderID?b.push(E.shaderID):(b.push(E.customVertexShaderID),b.push(E.customFragmentShaderID)),E.defines!==void 0)for(let A in E.defines)b.push(A),b.push(E.defines[A]);return E.isRawShaderMaterial===!1&&(S(b,E),v(b,E),b.push(i.outputColorSpace)),b.push(E.customProgramCacheKey),b.join()}function S(E,b){E.push(b.precision),E.push(b.outputColorSpace),E.push(b.envMapMode),E.push(b.envMapCubeUVHeight),E.push(b.mapUv),E.push(b.alphaMapUv),E.push(b.lightMapUv),E.push(b.aoMapUv),E.push(b.bumpMapUv),E.push(b.normalMapUv),E.push(b.displacementMapUv),E.push(b.emissiveMapUv),E.push(b.metalnessMapUv),E.push(b.roughnessMapUv),E.push(b.anisotropyMapUv),E.push(b.clearcoatMapUv),E.push(b.clearcoatNormalMapUv),E.push(b.clearcoatRoughnessMapUv),E.push(b.iridescenceMapUv),E.push(b.iridescenceThicknessMapUv),E.push(b.sheenColorMapUv),E.push(b.sheenRoughnessMapUv),E.push(b.specularMapUv),E.push(b.specularColorMapUv),E.push(b.specularIntensityMapUv),E.push(b.transmissionMapUv),E.push(b.thicknessMapUv),E.push(b.combine),E.push(b.fogExp2),E.push(b.sizeAttenuation),E.push(b.morphTargetsCount),E.push(b.morphAttributeCount),E.push(b.numDirLights),E.push(b.numPointLights),E.push(b.numSpotLights),E.push(b.numSpotLightMaps),E.push(b.numHemiLights),E.push(b.numRectAreaLights),E.push(b.numDirLightShadows),E.push(b.numPointLightShadows),E.push(b.numSpotLightShadows),E.push(b.numSpotLightShadowsWithMaps),E.push(b.numLightProbes),E.push(b.shadowMapType),E.push(b.toneMapping),E.push(b.numClippingPlanes),E.push(b.numClipIntersection),E.push(b.depthPacking)}function v(E,b){a.disableAll(),b.supportsVertexTextures&&a.enable(0),b.instancing&&a.enable(1),b.instancingColor&&a.enable(2),b.instancingMorph&&a.enable(3),b.matcap&&a.enable(4),b.envMap&&a.enable(5),b.normalMapObjectSpace&&a.enable(6),b.normalMapTangentSpace&&a.enable(7),b.clearcoat&&a.enable(8),b.iridescence&&a.enable(9),b.alphaTest&&a.enable(10),b.vertexColors&&a.enable(11),b.vertexAlphas&&a.enable(12),b.vertexUv1s&&a.enable(13),b.vertexUv2s&&a.enable(14),b.vertexUv3s&&a.enable(15),b.vertexTangents&&a.enable(16),b.anisotropy&&a.enable(17),b.alphaHash&&a.enable(18),b.batching&&a.enable(19),b.dispersion&&a.enable(20),b.batchingColor&&a.enable(21),E.push(a.mask),a.disableAll(),b.fog&&a.enable(0),b.useFog&&a.enable(1),b.flatShading&&a.enable(2),b.logarithmicDepthBuffer&&a.enable(3),b.reverseDepthBuffer&&a.enable(4),b.skinning&&a.enable(5),b.morphTargets&&a.enable(6),b.morphNormals&&a.enable(7),b.morphColors&&a.enable(8),b.premultipliedAlpha&&a.enable(9),b.shadowMapEnabled&&a.enable(10),b.doubleSided&&a.enable(11),b.flipSided&&a.enable(12),b.useDepthPacking&&a.enable(13),b.dithering&&a.enable(14),b.transmission&&a.enable(15),b.sheen&&a.enable(16),b.opaque&&a.enable(17),b.pointsUvs&&a.enable(18),b.decodeVideoTexture&&a.enable(19),b.decodeVideoTextureEmissive&&a.enable(20),b.alphaToCoverage&&a.enable(21),E.push(a.mask)}function y(E){let b=_[E.type],A;if(b){let O=Pi[b];A=Vx.clone(O.uniforms)}else A=E.uniforms;return A}function I(E,b){let A;for(let O=0,F=u.length;O<F;O++){let G=u[O];if(G.cacheKey===b){A=G,++A.usedTimes;break}}return A===void 0&&(A=new ZS(i,b,E,r),u.push(A)),A}function C(E){if(--E.usedTimes===0){let b=u.indexOf(E);u[b]=u[u.length-1],u.pop(),E.destroy()}}function R(E){l.remove(E)}function L(){l.dispose()}return{getParameters:m,getProgramCacheKey:d,getUniforms:y,acquireProgram:I,releaseProgram:C,releaseShaderCache:R,programs:u,dispose:L}}function jS(){let i=new WeakMap;function t(o){return i.has(o)}function e(o){let a=i.get(o);return a===void 0&&(a={},i.set(o,a)),a}function n(o){i.delete(o)}function s(o,a,l){i.get(o)[a]=l}function r(){i=new WeakMap}return{has:t,get:e,remove:n,update:s,dispose:r}}function QS(i,t){return i.groupOrder!==t.groupOrder?i.groupOrder-t.groupOrder:i.renderOrder!==t.renderOrder?i.renderOrder-t.renderOrder:i.material.id!==t.material.id?i.material.id-t.material.id:i.z!==t.z?i.z-t.z:i.id-t.id}function im(i,t){return i.groupOrder!==t.groupOrder?i.groupOrder-t.groupOrder:i.renderOrder!==t.renderOrder?i.renderOrder-t.renderOrder:i.z!==t.z?t.z-i.z:i.id-t.id}function sm(){let i=[],t=0,e=[],n=[],s=[];function r(){t=0,e.length=0,n.length=0,s.length=0}function o(f,h,p,_,g,m){let d=i[t];return d===void 0?(d={id:f.id,object:f,geometry:h,material:p,groupOrder:_,renderOrder:f.renderOrder,z:g,group:m},i[t]=d):(d.id=f.id,d.object=f,d.geometry=h,d.material=p,d.groupOrder=_,d.renderOrder=f.renderOrder,d.z=g,d.group=m),t++,d}function a(f,h,p,_,g,m){let d=o(f,h,p,_,g,m);p.transmission>0?n.push(d):p.transparent===!0?s.push(d):e.push(d)}function l(f,h,p,_,g,m){let d=o(f,h,p,_,g,m);p.transmission>0?n.unshift(d):p.transparent===!0?s.unshift(d):e.unshift(d)}function c(f,h){e.length>1&&e.sort(f||QS),n.length>1&&n.sort(h||im),s.length>1&&s.sort(h||im)}function u(){for(let f=t,h=i.length;f<h;f++){let p=i[f];if(p.id===null)break;p.id=null,p.object=null,p.geometry=null,p.material=null,p.group=null}}return{opaque:e,transmissive:n,transparent:s,init:r,push:a,unshift:l,finish:u,sort:c}}function tb(){let i=new WeakMap;function t(n,s){let r=i.get(n),o;return r===void 0?(o=new sm,i.set(n,[o])):s>=r.length?(o=new sm,r.push(o)):o=r[s],o}function e(){i=new WeakMap}return{get:t,dispose:e}}function eb(){let i={};return{get:function(t){if(i[t.id]!==void 0)return i[t.id];let e;switch(t.type){case"DirectionalLight":e={direction:new Y,color:new pe};break;case"SpotLight":e={position:new Y,direction:new Y,color:new pe,distance:0,coneCos:0,penumbraCos:0,decay:0};break;case"PointLight":e={position:new Y,color:new pe,distance:0,decay:0};break;case"HemisphereLight":e={direction:new Y,skyColor:new pe,groundColor:new pe};break;case"RectAreaLight":e={color:new pe,position:new Y,halfWidth:new Y,halfHeight:new Y};break}return i[t.id]=e,e}}}function nb(){let i={};return{get:function(t){if(i[t.id]!==void 0)return i[t.id];let e;switch(t.type){case"DirectionalLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new se};break;case"SpotLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new se};break;case"PointLight":e={shadowIntensity:1,shadowBias:0,shadowNormalBias:0,shadowRadius:1,shadowMapSize:new se,shadowCameraNear:1,shadowCameraFar:1e3};break}return i[t.id]=e,e}}}var ib=0;function sb(i,t){return(t.castShadow?2:0)-(i.castShadow?2:0)+(t.map?1:0)-(i.map?1:0)}function rb(i){let t=new eb,e=nb(),n={version:0,hash:{directionalLength:-1,pointLength:-1,spotLength:-1,rectAreaLength:-1,hemiLength:-1,numDirectionalShadows:-1,numPointShadows:-1,numSpotShadows:-1,numSpotMaps:-1,numLightProbes:-1},ambient:[0,0,0],probe:[],directional:[],directionalShadow:[],directionalShadowMap:[],directionalShadowMatrix:[],spot:[],spotLightMap:[],spotShadow:[],spotShadowMap:[],spotLightMatrix:[],rectArea:[],rectAreaLTC1:null,rectAreaLTC2:null,point:[],pointShadow:[],pointShadowMap:[],pointShadowMatrix:[],hemi:[],numSpotLightShadowsWithMaps:0,numLightProbes:0};for(let c=0;c<9;c++)n.probe.push(new Y);let s=new Y,r=new Ge,o=new Ge;function a(c){let u=0,f=0,h=0;for(let E=0;E<9;E++)n.probe[E].set(0,0,0);let p=0,_=0,g=0,m=0,d=0,S=0,v=0,y=0,I=0,C=0,R=0;c.sort(sb);for(let E=0,b=c.length;E<b;E++){let A=c[E],O=A.color,F=A.intensity,G=A.distance,$=A.shadow&&A.shadow.map?A.shadow.map.texture:null;if(A.isAmbientLight)u+=O.r*F,f+=O.g*F,h+=O.b*F;else if(A.isLightProbe){for(let W=0;W<9;W++)n.probe[W].addScaledVector(A.sh.coefficients[W],F);R++}else if(A.isDirectionalLight){let W=t.get(A);if(W.color.copy(A.color).multiplyScalar(A.intensity),A.castShadow){let Z=A.shadow,J=e.get(A);J.shadowIntensity=Z.intensity,J.shadowBias=Z.bias,J.shadowNormalBias=Z.normalBias,J.shadowRadius=Z.radius,J.shadowMapSize=Z.mapSize,n.directionalShadow[p]=J,n.directionalShadowMap[p]=$,n.directionalShadowMatrix[p]=A.shadow.matrix,S++}n.directional[p]=W,p++}else if(A.isSpotLight){let W=t.get(A);W.position.setFromMatrixPosition(A.matrixWorld),W.color.copy(O).multiplyScalar(F),W.distance=G,W.coneCos=Math.cos(A.angle),W.penumbraCos=Math.cos(A.angle*(1-A.penumbra)),W.decay=A.decay,n.spot[g]=W;let Z=A.shadow;if(A.map&&(n.spotLightMap[I]=A.map,I++,Z.updateMatrices(A),A.castShadow&&C++),n.spotLightMatrix[g]=Z.matrix,A.castShadow){let J=e.get(A);J.shadowIntensity=Z.intensity,J.shadowBias=Z.bias,J.shadowNormalBias=Z.normalBias,J.shadowRadius=Z.radius,J.shadowMapSize=Z.mapSize,n.spotShadow[g]=J,n.spotShadowMap[g]=$,y++}g++}else if(A.isRectAreaLight){let W=t.get(A);W.color.copy(O).multiplyScalar(F),W.halfWidth.set(A.width*.5,0,0),W.halfHeight.set(0,A.height*.5,0),n.rectArea[m]=W,m++}else if(A.isPointLight){let W=t.get(A);if(W.color.copy(A.color).multiplyScalar(A.intensity),W.distance=A.distance,W.decay=A.decay,A.castShadow){let Z=A.shadow,J=e.get(A);J.shadowIntensity=Z.intensity,J.shadowBias=Z.bias,J.shadowNormalBias=Z.normalBias,J.shadowRadius=Z.radius,J.shadowMapSize=Z.mapSize,J.shadowCameraNear=Z.camera.near,J.shadowCameraFar=Z.camera.far,n.pointShadow[_]=J,n.pointShadowMap[_]=$,n.pointShadowMatrix[_]=A.shadow.matrix,v++}n.point[_]=W,_++}else if(A.isHemisphereLight){let W=t.get(A);W.skyColor.copy(A.color).multiplyScalar(F),W.groundColor.copy(A.groundColor).multiplyScalar(F),n.hemi[d]=W,d++}}m>0&&(i.has("OES_texture_float_linear")===!0?(n.rectAreaLTC1=bt.LTC_FLOAT_1,n.rectAreaLTC2=bt.LTC_FLOAT_2):(n.rectAreaLTC1=bt.LTC_HALF_1,n.rectAreaLTC2=bt.LTC_HALF_2)),n.ambient[0]=u,n.ambient[1]=f,n.ambient[2]=h;let L=n.hash;(L.directionalLength!==p||L.pointLength!==_||L.spotLength!==g||L.rectAreaLength!==m||L.hemiLength!==d||L.numDirectionalShadows!==S||L.numPointShadows!==v||L.numSpotShadows!==y||L.numSpotMaps!==I||L.numLightProbes!==R)&&(n.directional.length=p,n.spot.length=g,n.rectArea.length=m,n.point.length=_,n.hemi.length=d,n.directionalShadow.length=S,n.directionalShadowMap.length=S,n.pointShadow.length=v,n.pointShadowMap.length=v,n.spotShadow.length=y,n.spotShadowMap.length=y,n.directionalShadowMatrix.length=S,n.pointShadowMatrix.length=v,n.spotLightMatrix.length=y+I-C,n.spotLightMap.length=I,n.numSpotLightShadowsWithMaps=C,n.numLightProbes=R,L.directionalLength=p,L.pointLength=_,L.spotLength=g,L.rectAreaLength=m,L.hemiLength=d,L.numDirectionalShadows=S,L.numPointShadows=v,L.numSpotShadows=y,L.numSpotMaps=I,L.numLightProbes=R,n.version=ib++)}function l(c,u){let f=0,h=0,p=0,_=0,g=0,m=u.matrixWorldInverse;for(let d=0,S=c.length;d<S;d++){let v=c[d];if(v.isDirectionalLight){let y=n.directional[f];y.direction.setFromMatrixPosition(v.matrixWorld),s.setFromMatrixPosition(v.target.matrixWorld),y.direction.sub(s),y.direction.transformDirection(m),f++}else if(v.isSpotLight){let y=n.spot[p];y.position.setFromMatrixPosition(v.matrixWorld),y.position.applyMatrix4(m),y.direction.setFromMatrixPosition(v.matrixWorld),s.setFromMatrixPosition(v.target.matrixWorld),y.direction.sub(s),y.direction.transformDirection(m),p++}else if(v.isRectAreaLight){let y=n.rectArea[_];y.position.setFromMatrixPosition(v.matrixWorld),y.position.applyMatrix4(m),o.identity(),r.copy(v.matrixWorld),r.premultiply(m),o.extractRotation(r),y.halfWidth.set(v.width*.5,0,0),y.halfHeight.set(0,v.height*.5,0),y.halfWidth.applyMatrix4(o),y.halfHeight.applyMatrix4(o),_++}else if(v.isPointLight){let y=n.point[h];y.position.setFromMatrixPosition(v.matrixWorld),y.position.applyMatrix4(m),h++}else if(v.isHemisphereLight){let y=n.hemi[g];y.direction.setFromMatrixPosition(v.matrixWorld),y.direction.transformDirection(m),g++}}}return{setup:a,setupView:l,state:n}}function rm(i){let t=new rb(i),e=[],n=[];function s(u){c.camera=u,e.length=0,n.length=0}function r(u){e.push(u)}function o(u){n.push(u)}function a(){t.setup(e)}function l(u){t.setupView(e,u)}let c={lightsArray:e,shadowsArray:n,camera:null,lights:t,transmissionRenderTarget:{}};return{init:s,state:c,setupLights:a,setupLightsView:l,pushLight:r,pushShadow:o}}function ob(i){let t=new WeakMap;function e(s,r=0){let o=t.get(s),a;return o===void 0?(a=new rm(i),t.set(s,[a])):r>=o.length?(a=new rm(i),o.push(a)):a=o[r],a}function n(){t=new WeakMap}return{get:e,dispose:n}}var au=class extends Ss{static get type(){return"MeshDepthMaterial"}constructor(t){super(),this.isMeshDepthMaterial=!0,this.depthPacking=j_,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.wireframe=!1,this.wireframeLinewidth=1,this.setValues(t)}copy(t){return super.copy(t),this.depthPacking=t.depthPacking,this.map=t.map,this.alphaMap=t.alphaMap,this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this}},lu=class extends Ss{static get type(){return"MeshDistanceMaterial"}constructor(t){super(),this.isMeshDistanceMaterial=!0,this.map=null,this.alphaMap=null,this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.setValues(t)}copy(t){return super.copy(t),this.map=t.map,this.alphaMap=t.alphaMap,this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this}},ab=`void main() {
	gl_Position = vec4( position, 1.0 );
}`,lb=`uniform sampler2D shadow_pass;
uniform vec2 resolution;
uniform float radius;
#include <packing>
void main() {
	const float samples = float( VSM_SAMPLES );
	float mean = 0.0;
	float squared_mean = 0.0;
	float uvStride = samples <= 1.0 ? 0.0 : 2.0 / ( samples - 1.0 );
	float uvStart = samples <= 1.0 ? 0.0 : - 1.0;
	for ( float i = 0.0; i < samples; i ++ ) {
		float uvOffset = uvStart + i * uvStride;
		#ifdef HORIZONTAL_PASS
			vec2 distribution = unpackRGBATo2Half( texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( uvOffset, 0.0 ) * radius ) / resolution ) );
			mean += distribution.x;
			squared_mean += distribution.y * distribution.y + distribution.x * distribution.x;
		#else
			float depth = unpackRGBAToDepth( texture2D( shadow_pass, ( gl_FragCoord.xy + vec2( 0.0, uvOffset ) * radius ) / resolution ) );
			mean += depth;
			squared_mean += depth * depth;
		#endif
	}
	mean = mean / samples;
	squared_mean = squared_mean / samples;
	float std_dev = sqrt( squared_mean - mean * mean );
	gl_FragColor = pack2HalfToRGBA( vec2( mean, std_dev ) );
}`;function cb(i,t,e){let n=new Vo,s=new se,r=new se,o=new He,a=new au({depthPacking:Q_}),l=new lu,c={},u=e.maxTextureSize,f={[Ms]:Nn,[Nn]:Ms,[ii]:ii},h=new Di({defines:{VSM_SAMPLES:8},uniforms:{shadow_pass:{value:null},resolution:{value:new se},radius:{value:4}},vertexShader:ab,fragmentShader:lb}),p=h.clone();p.defines.HORIZONTAL_PASS=1;let _=new Bn;_.setAttribute("position",new pn(new Float32Array([-1,-1,.5,3,-1,.5,-1,3,.5]),3));let g=new Cn(_,h),m=this;this.enabled=!1,this.autoUpdate=!0,this.needsUpdate=!1,this.type=dm;let d=this.type;this.render=function(C,R,L){if(m.enabled===!1||m.autoUpdate===!1&&m.needsUpdate===!1||C.length===0)return;let E=i.getRenderTarget(),b=i.getActiveCubeFace(),A=i.getActiveMipmapLevel(),O=i.state;O.setBlending(ys),O.buffers.color.setClear(1,1,1,1),O.buffers.depth.setTest(!0),O.setScissorTest(!1);let F=d!==Yi&&this.type===Yi,G=d===Yi&&this.type!==Yi;for(let $=0,W=C.length;$<W;$++){let Z=C[$],J=Z.shadow;if(J===void 0){console.warn("THREE.WebGLShadowMap:",Z,"has no shadow.");continue}if(J.autoUpdate===!1&&J.needsUpdate===!1)continue;s.copy(J.mapSize);let ct=J.getFrameExtents();if(s.multiply(ct),r.copy(J.mapSize),(s.x>u||s.y>u)&&(s.x>u&&(r.x=Math.floor(u/ct.x),s.x=r.x*ct.x,J.mapSize.x=r.x),s.y>u&&(r.y=Math.floor(u/ct.y),s.y=r.y*ct.y,J.mapSize.y=r.y)),J.map===null||F===!0||G===!0){let _t=this.type!==Yi?{minFilter:xi,magFilter:xi}:{};J.map!==null&&J.map.dispose(),J.map=new ts(s.x,s.y,_t),J.map.texture.name=Z.name+".shadowMap",J.camera.updateProjectionMatrix()}i.setRenderTarget(J.map),i.clear();let lt=J.getViewportCount();for(let _t=0;_t<lt;_t++){let dt=J.getViewport(_t);o.set(r.x*dt.x,r.y*dt.y,r.x*dt.z,r.y*dt.w),O.viewport(o),J.updateMatrices(Z,_t),n=J.getFrustum(),y(R,L,J.camera,Z,this.type)}J.isPointLightShadow!==!0&&this.type===Yi&&S(J,L),J.needsUpdate=!1}d=this.type,m.needsUpdate=!1,i.setRenderTarget(E,b,A)};function S(C,R){let L=t.update(g);h.defines.VSM_SAMPLES!==C.blurSamples&&(h.defines.VSM_SAMPLES=C.blurSamples,p.defines.VSM_SAMPLES=C.blurSamples,h.needsUpdate=!0,p.needsUpdate=!0),C.mapPass===null&&(C.mapPass=new ts(s.x,s.y)),h.uniforms.shadow_pass.value=C.map.texture,h.uniforms.resolution.value=C.mapSize,h.uniforms.radius.value=C.radius,i.setRenderTarget(C.mapPass),i.clear(),i.renderBufferDirect(R,null,L,h,g,null),p.uniforms.shadow_pass.value=C.mapPass.texture,p.uniforms.resolution.value=C.mapSize,p.uniforms.radius.value=C.radius,i.setRenderTarget(C.map),i.clear(),i.renderBufferDirect(R,null,L,p,g,null)}function v(C,R,L,E){let b=null,A=L.isPointLight===!0?C.customDistanceMaterial:C.customDepthMaterial;if(A!==void 0)b=A;else if(b=L.isPointLight===!0?l:a,i.localClippingEnabled&&R.clipShadows===!0&&Array.isArray(R.clippingPlanes)&&R.clippingPlanes.length!==0||R.displacementMap&&R.displacementScale!==0||R.alphaMap&&R.alphaTest>0||R.map&&R.alphaTest>0){let O=b.uuid,F=R.uuid,G=c[O];G===void 0&&(G={},c[O]=G);let $=G[F];$===void 0&&($=b.clone(),G[F]=$,R.addEventListener("dispose",I)),b=$}if(b.visible=R.visible,b.wireframe=R.wireframe,E===Yi?b.side=R.shadowSide!==null?R.shadowSide:R.side:b.side=R.shadowSide!==null?R.shadowSide:f[R.side],b.alphaMap=R.alphaMap,b.alphaTest=R.alphaTest,b.map=R.map,b.clipShadows=R.clipShadows,b.clippingPlanes=R.clippingPlanes,b.clipIntersection=R.clipIntersection,b.displacementMap=R.displacementMap,b.displacementScale=R.displacementScale,b.displacementBias=R.displacementBias,b.wireframeLinewidth=R.wireframeLinewidth,b.linewidth=R.linewidth,L.isPointLight===!0&&b.isMeshDistanceMaterial===!0){let O=i.properties.get(b);O.light=L}return b}function y(C,R,L,E,b){if(C.visible===!1)return;if(C.layers.test(R.layers)&&(C.isMesh||C.isLine||C.isPoints)&&(C.castShadow||C.receiveShadow&&b===Yi)&&(!C.frustumCulled||n.intersectsObject(C))){C.modelViewMatrix.multiplyMatrices(L.matrixWorldInverse,C.matrixWorld);let F=t.update(C),G=C.material;if(Array.isArray(G)){let $=F.groups;for(let W=0,Z=$.length;W<Z;W++){let J=$[W],ct=G[J.materialIndex];if(ct&&ct.visible){let lt=v(C,ct,E,b);C.onBeforeShadow(i,C,R,L,F,lt,J),i.renderBufferDirect(L,null,F,lt,C,J),C.onAfterShadow(i,C,R,L,F,lt,J)}}}else if(G.visible){let $=v(C,G,E,b);C.onBeforeShadow(i,C,R,L,F,$,null),i.renderBufferDirect(L,null,F,$,C,null),C.onAfterShadow(i,C,R,L,F,$,null)}}let O=C.children;for(let F=0,G=O.length;F<G;F++)y(O[F],R,L,E,b)}function I(C){C.target.removeEventListener("dispose",I);for(let L in c){let E=c[L],b=C.target.uuid;b in E&&(E[b].dispose(),delete E[b])}}}var hb={[fh]:dh,[ph]:_h,[mh]:xh,[$r]:gh,[dh]:fh,[_h]:ph,[xh]:mh,[gh]:$r};function ub(i,t){function e(){let B=!1,St=new He,nt=null,at=new He(0,0,0,0);return{setMask:function(Rt){nt!==Rt&&!B&&(i.colorMask(Rt,Rt,Rt,Rt),nt=Rt)},setLocked:function(Rt){B=Rt},setClear:function(Rt,Ct,ne,Fe,Ut){Ut===!0&&(Rt*=Fe,Ct*=Fe,ne*=Fe),St.set(Rt,Ct,ne,Fe),at.equals(St)===!1&&(i.clearColor(Rt,Ct,ne,Fe),at.copy(St))},reset:function(){B=!1,nt=null,at.set(-1,0,0,0)}}}function n(){let B=!1,St=!1,nt=null,at=null,Rt=null;return{setReversed:function(Ct){if(St!==Ct){let ne=t.get("EXT_clip_control");St?ne.clipControlEXT(ne.LOWER_LEFT_EXT,ne.ZERO_TO_ONE_EXT):ne.clipControlEXT(ne.LOWER_LEFT_EXT,ne.NEGATIVE_ONE_TO_ONE_EXT);let Fe=Rt;Rt=null,this.setClear(Fe)}St=Ct},getReversed:function(){return St},setTest:function(Ct){Ct?pt(i.DEPTH_TEST):zt(i.DEPTH_TEST)},setMask:function(Ct){nt!==Ct&&!B&&(i.depthMask(Ct),nt=Ct)},setFunc:function(Ct){if(St&&(Ct=hb[Ct]),at!==Ct){switch(Ct){case fh:i.depthFunc(i.NEVER);break;case dh:i.depthFunc(i.ALWAYS);break;case ph:i.depthFunc(i.LESS);break;case $r:i.depthFunc(i.LEQUAL);break;case mh:i.depthFunc(i.EQUAL);break;case gh:i.depthFunc(i.GEQUAL);break;case _h:i.depthFunc(i.GREATER);break;case xh:i.depthFunc(i.NOTEQUAL);break;default:i.depthFunc(i.LEQUAL)}at=Ct}},setLocked:function(Ct){B=Ct},setClear:function(Ct){Rt!==Ct&&(St&&(Ct=1-Ct),i.clearDepth(Ct),Rt=Ct)},reset:function(){B=!1,nt=null,at=null,Rt=null,St=!1}}}function s(){let B=!1,St=null,nt=null,at=null,Rt=null,Ct=null,ne=null,Fe=null,Ut=null;return{setTest:function(ce){B||(ce?pt(i.STENCIL_TEST):zt(i.STENCIL_TEST))},setMask:function(ce){St!==ce&&!B&&(i.stencilMask(ce),St=ce)},setFunc:function(ce,Te,rn){(nt!==ce||at!==Te||Rt!==rn)&&(i.stencilFunc(ce,Te,rn),nt=ce,at=Te,Rt=rn)},setOp:function(ce,Te,rn){(Ct!==ce||ne!==Te||Fe!==rn)&&(i.stencilOp(ce,Te,rn),Ct=ce,ne=Te,Fe=rn)},setLocked:function(ce){B=ce},setClear:function(ce){Ut!==ce&&(i.clearStencil(ce),Ut=ce)},reset:function(){B=!1,St=null,nt=null,at=null,Rt=null,Ct=null,ne=null,Fe=null,Ut=null}}}let r=new e,o=new n,a=new s,l=new WeakMap,c=new WeakMap,u={},f={},h=new WeakMap,p=[],_=null,g=!1,m=null,d=null,S=null,v=null,y=null,I=null,C=null,R=new pe(0,0,0),L=0,E=!1,b=null,A=null,O=null,F=null,G=null,$=i.getParameter(i.MAX_COMBINED_TEXTURE_IMAGE_UNITS),W=!1,Z=0,J=i.getParameter(i.VERSION);J.indexOf("WebGL")!==-1?(Z=parseFloat(/^WebGL (\d)/.exec(J)[1]),W=Z>=1):J.indexOf("OpenGL ES")!==-1&&(Z=parseFloat(/^OpenGL ES (\d)/.exec(J)[1]),W=Z>=2);let ct=null,lt={},_t=i.getParameter(i.SCISSOR_BOX),dt=i.getParameter(i.VIEWPORT),Yt=new He().fromArray(_t),Q=new He().fromArray(dt);function ht(B,St,nt,at){let Rt=new Uint8Array(4),Ct=i.createTexture();i.bindTexture(B,Ct),i.texParameteri(B,i.TEXTURE_MIN_FILTER,i.NEAREST),i.texParameteri(B,i.TEXTURE_MAG_FILTER,i.NEAREST);for(let ne=0;ne<nt;ne++)B===i.TEXTURE_3D||B===i.TEXTURE_2D_ARRAY?i.texImage3D(St,0,i.RGBA,1,1,at,0,i.RGBA,i.UNSIGNED_BYTE,Rt):i.texImage2D(St+ne,0,i.RGBA,1,1,0,i.RGBA,i.UNSIGNED_BYTE,Rt);return Ct}let Bt={};Bt[i.TEXTURE_2D]=ht(i.TEXTURE_2D,i.TEXTURE_2D,1),Bt[i.TEXTURE_CUBE_MAP]=ht(i.TEXTURE_CUBE_MAP,i.TEXTURE_CUBE_MAP_POSITIVE_X,6),Bt[i.TEXTURE_2D_ARRAY]=ht(i.TEXTURE_2D_ARRAY,i.TEXTURE_2D_ARRAY,1,1),Bt[i.TEXTURE_3D]=ht(i.TEXTURE_3D,i.TEXTURE_3D,1,1),r.setClear(0,0,0,1),o.setClear(1),a.setClear(0),pt(i.DEPTH_TEST),o.setFunc($r),Qt(!1),$t(op),pt(i.CULL_FACE),N(ys);function pt(B){u[B]!==!0&&(i.enable(B),u[B]=!0)}function zt(B){u[B]!==!1&&(i.disable(B),u[B]=!1)}function j(B,St){return f[B]!==St?(i.bindFramebuffer(B,St),f[B]=St,B===i.DRAW_FRAMEBUFFER&&(f[i.FRAMEBUFFER]=St),B===i.FRAMEBUFFER&&(f[i.DRAW_FRAMEBUFFER]=St),!0):!1}function st(B,St){let nt=p,at=!1;if(B){nt=h.get(St),nt===void 0&&(nt=[],h.set(St,nt));let Rt=B.textures;if(nt.length!==Rt.length||nt[0]!==i.COLOR_ATTACHMENT0){for(let Ct=0,ne=Rt.length;Ct<ne;Ct++)nt[Ct]=i.COLOR_ATTACHMENT0+Ct;nt.length=Rt.length,at=!0}}else nt[0]!==i.BACK&&(nt[0]=i.BACK,at=!0);at&&i.drawBuffers(nt)}function It(B){return _!==B?(i.useProgram(B),_=B,!0):!1}let yt={[qs]:i.FUNC_ADD,[E_]:i.FUNC_SUBTRACT,[T_]:i.FUNC_REVERSE_SUBTRACT};yt[A_]=i.MIN,yt[C_]=i.MAX;let Zt={[R_]:i.ZERO,[P_]:i.ONE,[I_]:i.SRC_COLOR,[hh]:i.SRC_ALPHA,[F_]:i.SRC_ALPHA_SATURATE,[N_]:i.DST_COLOR,[D_]:i.DST_ALPHA,[L_]:i.ONE_MINUS_SRC_COLOR,[uh]:i.ONE_MINUS_SRC_ALPHA,[O_]:i.ONE_MINUS_DST_COLOR,[U_]:i.ONE_MINUS_DST_ALPHA,[B_]:i.CONSTANT_COLOR,[k_]:i.ONE_MINUS_CONSTANT_COLOR,[z_]:i.CONSTANT_ALPHA,[V_]:i.ONE_MINUS_CONSTANT_ALPHA};function N(B,St,nt,at,Rt,Ct,ne,Fe,Ut,ce){if(B===ys){g===!0&&(zt(i.BLEND),g=!1);return}if(g===!1&&(pt(i.BLEND),g=!0),B!==w_){if(B!==m||ce!==E){if((d!==qs||y!==qs)&&(i.blendEquation(i.FUNC_ADD),d=qs,y=qs),ce)switch(B){case Wr:i.blendFuncSeparate(i.ONE,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case ap:i.blendFunc(i.ONE,i.ONE);break;case lp:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case cp:i.blendFuncSeparate(i.ZERO,i.SRC_COLOR,i.ZERO,i.SRC_ALPHA);break;default:console.error("THREE.WebGLState: Invalid blending: ",B);break}else switch(B){case Wr:i.blendFuncSeparate(i.SRC_ALPHA,i.ONE_MINUS_SRC_ALPHA,i.ONE,i.ONE_MINUS_SRC_ALPHA);break;case ap:i.blendFunc(i.SRC_ALPHA,i.ONE);break;case lp:i.blendFuncSeparate(i.ZERO,i.ONE_MINUS_SRC_COLOR,i.ZERO,i.ONE);break;case cp:i.blendFunc(i.ZERO,i.SRC_COLOR);break;default:console.error("THREE.WebGLState: Invalid blending: ",B);break}S=null,v=null,I=null,C=null,R.set(0,0,0),L=0,m=B,E=ce}return}Rt=Rt||St,Ct=Ct||nt,ne=ne||at,(St!==d||Rt!==y)&&(i.blendEquationSeparate(yt[St],yt[Rt]),d=St,y=Rt),(nt!==S||at!==v||Ct!==I||ne!==C)&&(i.blendFuncSeparate(Zt[nt],Zt[at],Zt[Ct],Zt[ne]),S=nt,v=at,I=Ct,C=ne),(Fe.equals(R)===!1||Ut!==L)&&(i.blendColor(Fe.r,Fe.g,Fe.b,Ut),R.copy(Fe),L=Ut),m=B,E=!1}function le(B,St){B.side===ii?zt(i.CULL_FACE):pt(i.CULL_FACE);let nt=B.side===Nn;St&&(nt=!nt),Qt(nt),B.blending===Wr&&B.transparent===!1?N(ys):N(B.blending,B.blendEquation,B.blendSrc,B.blendDst,B.blendEquationAlpha,B.blendSrcAlpha,B.blendDstAlpha,B.blendColor,B.blendAlpha,B.premultipliedAlpha),o.setFunc(B.depthFunc),o.setTest(B.depthTest),o.setMask(B.depthWrite),r.setMask(B.colorWrite);let at=B.stencilWrite;a.setTest(at),at&&(a.setMask(B.stencilWriteMask),a.setFunc(B.stencilFunc,B.stencilRef,B.stencilFuncMask),a.setOp(B.stencilFail,B.stencilZFail,B.stencilZPass)),me(B.polygonOffset,B.polygonOffsetFactor,B.polygonOffsetUnits),B.alphaToCoverage===!0?pt(i.SAMPLE_ALPHA_TO_COVERAGE):zt(i.SAMPLE_ALPHA_TO_COVERAGE)}function Qt(B){b!==B&&(B?i.frontFace(i.CW):i.frontFace(i.CCW),b=B)}function $t(B){B!==M_?(pt(i.CULL_FACE),B!==A&&(B===op?i.cullFace(i.BACK):B===S_?i.cullFace(i.FRONT):i.cullFace(i.FRONT_AND_BACK))):zt(i.CULL_FACE),A=B}function Dt(B){B!==O&&(W&&i.lineWidth(B),O=B)}function me(B,St,nt){B?(pt(i.POLYGON_OFFSET_FILL),(F!==St||G!==nt)&&(i.polygonOffset(St,nt),F=St,G=nt)):zt(i.POLYGON_OFFSET_FILL)}function Tt(B){B?pt(i.SCISSOR_TEST):zt(i.SCISSOR_TEST)}function P(B){B===void 0&&(B=i.TEXTURE0+$-1),ct!==B&&(i.activeTexture(B),ct=B)}function M(B,St,nt){nt===void 0&&(ct===null?nt=i.TEXTURE0+$-1:nt=ct);let at=lt[nt];at===void 0&&(at={type:void 0,texture:void 0},lt[nt]=at),(at.type!==B||at.texture!==St)&&(ct!==nt&&(i.activeTexture(nt),ct=nt),i.bindTexture(B,St||Bt[B]),at.type=B,at.texture=St)}function V(){let B=lt[ct];B!==void 0&&B.type!==void 0&&(i.bindTexture(B.type,null),B.type=void 0,B.texture=void 0)}function rt(){try{i.compressedTexImage2D.apply(i,arguments)}catch(B){console.error("THREE.WebGLState:",B)}}function et(){try{i.compressedTexImage3D.apply(i,arguments)}catch(B){console.error("THREE.WebGLState:",B)}}function it(){try{i.texSubImage2D.apply(i,arguments)}catch(B){console.error("THREE.WebGLState:",B)}}function kt(){try{i.texSubImage3D.apply(i,arguments)}catch(B){console.error("THREE.WebGLState:",B)}}function vt(){try{i.compressedTexSubImage2D.apply(i,arguments)}catch(B){console.error("THREE.WebGLState:",B)}}function wt(){try{i.compressedTexSubImage3D.apply(i,arguments)}catch(B){console.error("THREE.WebGLState:",B)}}function Kt(){try{i.texStorage2D.apply(i,arguments)}catch(B){console.error("THREE.WebGLState:",B)}}function ut(){try{i.texStorage3D.apply(i,arguments)}catch(B){console.error("THREE.WebGLState:",B)}}function Mt(){try{i.texImage2D.apply(i,arguments)}catch(B){console.error("THREE.WebGLState:",B)}}function Wt(){try{i.texImage3D.apply(i,arguments)}catch(B){console.error("THREE.WebGLState:",B)}}function qt(B){Yt.equals(B)===!1&&(i.scissor(B.x,B.y,B.z,B.w),Yt.copy(B))}function At(B){Q.equals(B)===!1&&(i.viewport(B.x,B.y,B.z,B.w),Q.copy(B))}function re(B,St){let nt=c.get(St);nt===void 0&&(nt=new WeakMap,c.set(St,nt));let at=nt.get(B);at===void 0&&(at=i.getUniformBlockIndex(St,B.name),nt.set(B,at))}function jt(B,St){let at=c.get(St).get(B);l.get(St)!==at&&(i.uniformBlockBinding(St,at,B.__bindingPointIndex),l.set(St,at))}function Me(){i.disable(i.BLEND),i.disable(i.CULL_FACE),i.disable(i.DEPTH_TEST),i.disable(i.POLYGON_OFFSET_FILL),i.disable(i.SCISSOR_TEST),i.disable(i.STENCIL_TEST),i.disable(i.SAMPLE_ALPHA_TO_COVERAGE),i.blendEquation(i.FUNC_ADD),i.blendFunc(i.ONE,i.ZERO),i.blendFuncSeparate(i.ONE,i.ZERO,i.ONE,i.ZERO),i.blendColor(0,0,0,0),i.colorMask(!0,!0,!0,!0),i.clearColor(0,0,0,0),i.depthMask(!0),i.depthFunc(i.LESS),o.setReversed(!1),i.clearDepth(1),i.stencilMask(4294967295),i.stencilFunc(i.ALWAYS,0,4294967295),i.stencilOp(i.KEEP,i.KEEP,i.KEEP),i.clearStencil(0),i.cullFace(i.BACK),i.frontFace(i.CCW),i.polygonOffset(0,0),i.activeTexture(i.TEXTURE0),i.bindFramebuffer(i.FRAMEBUFFER,null),i.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),i.bindFramebuffer(i.READ_FRAMEBUFFER,null),i.useProgram(null),i.lineWidth(1),i.scissor(0,0,i.canvas.width,i.canvas.height),i.viewport(0,0,i.canvas.width,i.canvas.height),u={},ct=null,lt={},f={},h=new WeakMap,p=[],_=null,g=!1,m=null,d=null,S=null,v=null,y=null,I=null,C=null,R=new pe(0,0,0),L=0,E=!1,b=null,A=null,O=null,F=null,G=null,Yt.set(0,0,i.canvas.width,i.canvas.height),Q.set(0,0,i.canvas.width,i.canvas.height),r.reset(),o.reset(),a.reset()}return{buffers:{color:r,depth:o,stencil:a},enable:pt,disable:zt,bindFramebuffer:j,drawBuffers:st,useProgram:It,setBlending:N,setMaterial:le,setFlipSided:Qt,setCullFace:$t,setLineWidth:Dt,setPolygonOffset:me,setScissorTest:Tt,activeTexture:P,bindTexture:M,unbindTexture:V,compressedTexImage2D:rt,compressedTexImage3D:et,texImage2D:Mt,texImage3D:Wt,updateUBOMapping:re,uniformBlockBinding:jt,texStorage2D:Kt,texStorage3D:ut,texSubImage2D:it,texSubImage3D:kt,compressedTexSubImage2D:vt,compressedTexSubImage3D:wt,scissor:qt,viewport:At,reset:Me}}function om(i,t,e,n){let s=fb(n);switch(e){case ym:return i*t;case Mm:return i*t;case Sm:return i*t*2;case bm:return i*t/s.components*s.byteLength;case Cu:return i*t/s.components*s.byteLength;case wm:return i*t*2/s.components*s.byteLength;case Ru:return i*t*2/s.components*s.byteLength;case vm:return i*t*3/s.components*s.byteLength;case _i:return i*t*4/s.components*s.byteLength;case Pu:return i*t*4/s.components*s.byteLength;case $a:case Za:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*8;case Ja:case Ka:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case wh:case Th:return Math.max(i,16)*Math.max(t,8)/4;case bh:case Eh:return Math.max(i,8)*Math.max(t,8)/2;case Ah:case Ch:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*8;case Rh:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case Ph:return Math.floor((i+3)/4)*Math.floor((t+3)/4)*16;case Ih:return Math.floor((i+4)/5)*Math.floor((t+3)/4)*16;case Lh:return Math.floor((i+4)/5)*Math.floor((t+4)/5)*16;case Dh:return Math.floor((i+5)/6)*Math.floor((t+4)/5)*16;case Uh:return Math.floor((i+5)/6)*Math.floor((t+5)/6)*16;case Nh:return Math.floor((i+7)/8)*Math.floor((t+4)/5)*16;case Oh:return Math.floor((i+7)/8)*Math.floor((t+5)/6)*16;case Fh:return Math.floor((i+7)/8)*Math.floor((t+7)/8)*16;case Bh:return Math.floor((i+9)/10)*Math.floor((t+4)/5)*16;case kh:return Math.floor((i+9)/10)*Math.floor((t+5)/6)*16;case zh:return Math.floor((i+9)/10)*Math.floor((t+7)/8)*16;case Vh:return Math.floor((i+9)/10)*Math.floor((t+9)/10)*16;case Hh:return Math.floor((i+11)/12)*Math.floor((t+9)/10)*16;case Gh:return Math.floor((i+11)/12)*Math.floor((t+11)/12)*16;case ja:case Wh:case Xh:return Math.ceil(i/4)*Math.ceil(t/4)*16;case Em:case qh:return Math.ceil(i/4)*Math.ceil(t/4)*8;case Yh:case $h:return Math.ceil(i/4)*Math.ceil(t/4)*16}throw new Error(`Unable to determine texture byte length for ${e} format.`)}function fb(i){switch(i){case ji:case gm:return{byteLength:1,components:1};case Bo:case _m:case Xo:return{byteLength:2,components:1};case Tu:case Au:return{byteLength:2,components:4};case Ks:case Eu:case $i:return{byteLength:4,components:1};case xm:return{byteLength:4,components:3}}throw new Error(`Unknown texture type ${i}.`)}function db(i,t,e,n,s,r,o){let a=t.has("WEBGL_multisampled_render_to_texture")?t.get("WEBGL_multisampled_render_to_texture"):null,l=typeof navigator>"u"?!1:/OculusBrowser/g.test(navigator.userAgent),c=new se,u=new WeakMap,f,h=new WeakMap,p=!1;try{p=typeof OffscreenCanvas<"u"&&new OffscreenCanvas(1,1).getContext("2d")!==null}catch{}function _(P,M){return p?new OffscreenCanvas(P,M):el("canvas")}function g(P,M,V){let rt=1,et=Tt(P);if((et.width>V||et.height>V)&&(rt=V/Math.max(et.width,et.height)),rt<1)if(typeof HTMLImageElement<"u"&&P instanceof HTMLImageElement||typeof HTMLCanvasElement<"u"&&P instanceof HTMLCanvasElement||typeof ImageBitmap<"u"&&P instanceof ImageBitmap||typeof VideoFrame<"u"&&P instanceof VideoFrame){let it=Math.floor(rt*et.width),kt=Math.floor(rt*et.height);f===void 0&&(f=_(it,kt));let vt=M?_(it,kt):f;return vt.width=it,vt.height=kt,vt.getContext("2d").drawImage(P,0,0,it,kt),console.warn("THREE.WebGLRenderer: Texture has been resized from ("+et.width+"x"+et.height+") to ("+it+"x"+kt+")."),vt}else return"data"in P&&console.warn("THREE.WebGLRenderer: Image in DataTexture is too big ("+et.width+"x"+et.height+")."),P;return P}function m(P){return P.generateMipmaps}function d(P){i.generateMipmap(P)}function S(P){return P.isWebGLCubeRenderTarget?i.TEXTURE_CUBE_MAP:P.isWebGL3DRenderTarget?i.TEXTURE_3D:P.isWebGLArrayRenderTarget||P.isCompressedArrayTexture?i.TEXTURE_2D_ARRAY:i.TEXTURE_2D}function v(P,M,V,rt,et=!1){if(P!==null){if(i[P]!==void 0)return i[P];console.warn("THREE.WebGLRenderer: Attempt to use non-existing WebGL internal format '"+P+"'")}let it=M;if(M===i.RED&&(V===i.FLOAT&&(it=i.R32F),V===i.HALF_FLOAT&&(it=i.R16F),V===i.UNSIGNED_BYTE&&(it=i.R8)),M===i.RED_INTEGER&&(V===i.UNSIGNED_BYTE&&(it=i.R8UI),V===i.UNSIGNED_SHORT&&(it=i.R16UI),V===i.UNSIGNED_INT&&(it=i.R32UI),V===i.BYTE&&(it=i.R8I),V===i.SHORT&&(it=i.R16I),V===i.INT&&(it=i.R32I)),M===i.RG&&(V===i.FLOAT&&(it=i.RG32F),V===i.HALF_FLOAT&&(it=i.RG16F),V===i.UNSIGNED_BYTE&&(it=i.RG8)),M===i.RG_INTEGER&&(V===i.UNSIGNED_BYTE&&(it=i.RG8UI),V===i.UNSIGNED_SHORT&&(it=i.RG16UI),V===i.UNSIGNED_INT&&(it=i.RG32UI),V===i.BYTE&&(it=i.RG8I),V===i.SHORT&&(it=i.RG16I),V===i.INT&&(it=i.RG32I)),M===i.RGB_INTEGER&&(V===i.UNSIGNED_BYTE&&(it=i.RGB8UI),V===i.UNSIGNED_SHORT&&(it=i.RGB16UI),V===i.UNSIGNED_INT&&(it=i.RGB32UI),V===i.BYTE&&(it=i.RGB8I),V===i.SHORT&&(it=i.RGB16I),V===i.INT&&(it=i.RGB32I)),M===i.RGBA_INTEGER&&(V===i.UNSIGNED_BYTE&&(it=i.RGBA8UI),V===i.UNSIGNED_SHORT&&(it=i.RGBA16UI),V===i.UNSIGNED_INT&&(it=i.RGBA32UI),V===i.BYTE&&(it=i.RGBA8I),V===i.SHORT&&(it=i.RGBA16I),V===i.INT&&(it=i.RGBA32I)),M===i.RGB&&V===i.UNSIGNED_INT_5_9_9_9_REV&&(it=i.RGB9_E5),M===i.RGBA){let kt=et?El:ye.getTransfer(rt);V===i.FLOAT&&(it=i.RGBA32F),V===i.HALF_FLOAT&&(it=i.RGBA16F),V===i.UNSIGNED_BYTE&&(it=kt===Ce?i.SRGB8_ALPHA8:i.RGBA8),V===i.UNSIGNED_SHORT_4_4_4_4&&(it=i.RGBA4),V===i.UNSIGNED_SHORT_5_5_5_1&&(it=i.RGB5_A1)}return(it===i.R16F||it===i.R32F||it===i.RG16F||it===i.RG32F||it===i.RGBA16F||it===i.RGBA32F)&&t.get("EXT_color_buffer_float"),it}function y(P,M){let V;return P?M===null||M===Ks||M===Kr?V=i.DEPTH24_STENCIL8:M===$i?V=i.DEPTH32F_STENCIL8:M===Bo&&(V=i.DEPTH24_STENCIL8,console.warn("DepthTexture: 16 bit depth attachment is not supported with stencil. Using 24-bit attachment.")):M===null||M===Ks||M===Kr?V=i.DEPTH_COMPONENT24:M===$i?V=i.DEPTH_COMPONENT32F:M===Bo&&(V=i.DEPTH_COMPONENT16),V}function I(P,M){return m(P)===!0||P.isFramebufferTexture&&P.minFilter!==xi&&P.minFilter!==Ii?Math.log2(Math.max(M.width,M.height))+1:P.mipmaps!==void 0&&P.mipmaps.length>0?P.mipmaps.length:P.isCompressedTexture&&Array.isArray(P.image)?M.mipmaps.length:1}function C(P){let M=P.target;M.removeEventListener("dispose",C),L(M),M.isVideoTexture&&u.delete(M)}function R(P){let M=P.target;M.removeEventListener("dispose",R),b(M)}function L(P){let M=n.get(P);if(M.__webglInit===void 0)return;let V=P.source,rt=h.get(V);if(rt){let et=rt[M.__cacheKey];et.usedTimes--,et.usedTimes===0&&E(P),Object.keys(rt).length===0&&h.delete(V)}n.remove(P)}function E(P){let M=n.get(P);i.deleteTexture(M.__webglTexture);let V=P.source,rt=h.get(V);delete rt[M.__cacheKey],o.memory.textures--}function b(P){let M=n.get(P);if(P.depthTexture&&(P.depthTexture.dispose(),n.remove(P.depthTexture)),P.isWebGLCubeRenderTarget)for(let rt=0;rt<6;rt++){if(Array.isArray(M.__webglFramebuffer[rt]))for(let et=0;et<M.__webglFramebuffer[rt].length;et++)i.deleteFramebuffer(M.__webglFramebuffer[rt][et]);else i.deleteFramebuffer(M.__webglFramebuffer[rt]);M.__webglDepthbuffer&&i.deleteRenderbuffer(M.__webglDepthbuffer[rt])}else{if(Array.isArray(M.__webglFramebuffer))for(let rt=0;rt<M.__webglFramebuffer.length;rt++)i.deleteFramebuffer(M.__webglFramebuffer[rt]);else i.deleteFramebuffer(M.__webglFramebuffer);if(M.__webglDepthbuffer&&i.deleteRenderbuffer(M.__webglDepthbuffer),M.__webglMultisampledFramebuffer&&i.deleteFramebuffer(M.__webglMultisampledFramebuffer),M.__webglColorRenderbuffer)for(let rt=0;rt<M.__webglColorRenderbuffer.length;rt++)M.__webglColorRenderbuffer[rt]&&i.deleteRenderbuffer(M.__webglColorRenderbuffer[rt]);M.__webglDepthRenderbuffer&&i.deleteRenderbuffer(M.__webglDepthRenderbuffer)}let V=P.textures;for(let rt=0,et=V.length;rt<et;rt++){let it=n.get(V[rt]);it.__webglTexture&&(i.deleteTexture(it.__webglTexture),o.memory.textures--),n.remove(V[rt])}n.remove(P)}let A=0;function O(){A=0}function F(){let P=A;return P>=s.maxTextures&&console.warn("THREE.WebGLTextures: Trying to use "+P+" texture units while this GPU supports only "+s.maxTextures),A+=1,P}function G(P){let M=[];return M.push(P.wrapS),M.push(P.wrapT),M.push(P.wrapR||0),M.push(P.magFilter),M.push(P.minFilter),M.push(P.anisotropy),M.push(P.internalFormat),M.push(P.format),M.push(P.type),M.push(P.generateMipmaps),M.push(P.premultiplyAlpha),M.push(P.flipY),M.push(P.unpackAlignment),M.push(P.colorSpace),M.join()}function $(P,M){let V=n.get(P);if(P.isVideoTexture&&Dt(P),P.isRenderTargetTexture===!1&&P.version>0&&V.__version!==P.version){let rt=P.image;if(rt===null)console.warn("THREE.WebGLRenderer: Texture marked for update but no image data found.");else if(rt.complete===!1)console.warn("THREE.WebGLRenderer: Texture marked for update but image is incomplete");else{Q(V,P,M);return}}e.bindTexture(i.TEXTURE_2D,V.__webglTexture,i.TEXTURE0+M)}function W(P,M){let V=n.get(P);if(P.version>0&&V.__version!==P.version){Q(V,P,M);return}e.bindTexture(i.TEXTURE_2D_ARRAY,V.__webglTexture,i.TEXTURE0+M)}function Z(P,M){let V=n.get(P);if(P.version>0&&V.__version!==P.version){Q(V,P,M);return}e.bindTexture(i.TEXTURE_3D,V.__webglTexture,i.TEXTURE0+M)}function J(P,M){let V=n.get(P);if(P.version>0&&V.__version!==P.version){ht(V,P,M);return}e.bindTexture(i.TEXTURE_CUBE_MAP,V.__webglTexture,i.TEXTURE0+M)}let ct={[Mh]:i.REPEAT,[Zs]:i.CLAMP_TO_EDGE,[Sh]:i.MIRRORED_REPEAT},lt={[xi]:i.NEAREST,[K_]:i.NEAREST_MIPMAP_NEAREST,[wa]:i.NEAREST_MIPMAP_LINEAR,[Ii]:i.LINEAR,[Uc]:i.LINEAR_MIPMAP_NEAREST,[Js]:i.LINEAR_MIPMAP_LINEAR},_t={[ex]:i.NEVER,[ax]:i.ALWAYS,[nx]:i.LESS,[Am]:i.LEQUAL,[ix]:i.EQUAL,[ox]:i.GEQUAL,[sx]:i.GREATER,[rx]:i.NOTEQUAL};function dt(P,M){if(M.type===$i&&t.has("OES_texture_float_linear")===!1&&(M.magFilter===Ii||M.magFilter===Uc||M.magFilter===wa||M.magFilter===Js||M.minFilter===Ii||M.minFilter===Uc||M.minFilter===wa||M.minFilter===Js)&&console.warn("THREE.WebGLRenderer: Unable to use linear filtering with floating point textures. OES_texture_float_linear not supported on this device."),i.texParameteri(P,i.TEXTURE_WRAP_S,ct[M.wrapS]),i.texParameteri(P,i.TEXTURE_WRAP_T,ct[M.wrapT]),(P===i.TEXTURE_3D||P===i.TEXTURE_2D_ARRAY)&&i.texParameteri(P,i.TEXTURE_WRAP_R,ct[M.wrapR]),i.texParameteri(P,i.TEXTURE_MAG_FILTER,lt[M.magFilter]),i.texParameteri(P,i.TEXTURE_MIN_FILTER,lt[M.minFilter]),M.compareFunction&&(i.texParameteri(P,i.TEXTURE_COMPARE_MODE,i.COMPARE_REF_TO_TEXTURE),i.texParameteri(P,i.TEXTURE_COMPARE_FUNC,_t[M.compareFunction])),t.has("EXT_texture_filter_anisotropic")===!0){if(M.magFilter===xi||M.minFilter!==wa&&M.minFilter!==Js||M.type===$i&&t.has("OES_texture_float_linear")===!1)return;if(M.anisotropy>1||n.get(M).__currentAnisotropy){let V=t.get("EXT_texture_filter_anisotropic");i.texParameterf(P,V.TEXTURE_MAX_ANISOTROPY_EXT,Math.min(M.anisotropy,s.getMaxAnisotropy())),n.get(M).__currentAnisotropy=M.anisotropy}}}function Yt(P,M){let V=!1;P.__webglInit===void 0&&(P.__webglInit=!0,M.addEventListener("dispose",C));let rt=M.source,et=h.get(rt);et===void 0&&(et={},h.set(rt,et));let it=G(M);if(it!==P.__cacheKey){et[it]===void 0&&(et[it]={texture:i.createTexture(),usedTimes:0},o.memory.textures++,V=!0),et[it].usedTimes++;let kt=et[P.__cacheKey];kt!==void 0&&(et[P.__cacheKey].usedTimes--,kt.usedTimes===0&&E(M)),P.__cacheKey=it,P.__webglTexture=et[it].texture}return V}function Q(P,M,V){let rt=i.TEXTURE_2D;(M.isDataArrayTexture||M.isCompressedArrayTexture)&&(rt=i.TEXTURE_2D_ARRAY),M.isData3DTexture&&(rt=i.TEXTURE_3D);let et=Yt(P,M),it=M.source;e.bindTexture(rt,P.__webglTexture,i.TEXTURE0+V);let kt=n.get(it);if(it.version!==kt.__version||et===!0){e.activeTexture(i.TEXTURE0+V);let vt=ye.getPrimaries(ye.workingColorSpace),wt=M.colorSpace===xs?null:ye.getPrimaries(M.colorSpace),Kt=M.colorSpace===xs||vt===wt?i.NONE:i.BROWSER_DEFAULT_WEBGL;i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,M.flipY),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,M.premultiplyAlpha),i.pixelStorei(i.UNPACK_ALIGNMENT,M.unpackAlignment),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,Kt);let ut=g(M.image,!1,s.maxTextureSize);ut=me(M,ut);let Mt=r.convert(M.format,M.colorSpace),Wt=r.convert(M.type),qt=v(M.internalFormat,Mt,Wt,M.colorSpace,M.isVideoTexture);dt(rt,M);let At,re=M.mipmaps,jt=M.isVideoTexture!==!0,Me=kt.__version===void 0||et===!0,B=it.dataReady,St=I(M,ut);if(M.isDepthTexture)qt=y(M.format===jr,M.type),Me&&(jt?e.texStorage2D(i.TEXTURE_2D,1,qt,ut.width,ut.height):e.texImage2D(i.TEXTURE_2D,0,qt,ut.width,ut.height,0,Mt,Wt,null));else if(M.isDataTexture)if(re.length>0){jt&&Me&&e.texStorage2D(i.TEXTURE_2D,St,qt,re[0].width,re[0].height);for(let nt=0,at=re.length;nt<at;nt++)At=re[nt],jt?B&&e.texSubImage2D(i.TEXTURE_2D,nt,0,0,At.width,At.height,Mt,Wt,At.data):e.texImage2D(i.TEXTURE_2D,nt,qt,At.width,At.height,0,Mt,Wt,At.data);M.generateMipmaps=!1}else jt?(Me&&e.texStorage2D(i.TEXTURE_2D,St,qt,ut.width,ut.height),B&&e.texSubImage2D(i.TEXTURE_2D,0,0,0,ut.width,ut.height,Mt,Wt,ut.data)):e.texImage2D(i.TEXTURE_2D,0,qt,ut.width,ut.height,0,Mt,Wt,ut.data);else if(M.isCompressedTexture)if(M.isCompressedArrayTexture){jt&&Me&&e.texStorage3D(i.TEXTURE_2D_ARRAY,St,qt,re[0].width,re[0].height,ut.depth);for(let nt=0,at=re.length;nt<at;nt++)if(At=re[nt],M.format!==_i)if(Mt!==null)if(jt){if(B)if(M.layerUpdates.size>0){let Rt=om(At.width,At.height,M.format,M.type);for(let Ct of M.layerUpdates){let ne=At.data.subarray(Ct*Rt/At.data.BYTES_PER_ELEMENT,(Ct+1)*Rt/At.data.BYTES_PER_ELEMENT);e.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,nt,0,0,Ct,At.width,At.height,1,Mt,ne)}M.clearLayerUpdates()}else e.compressedTexSubImage3D(i.TEXTURE_2D_ARRAY,nt,0,0,0,At.width,At.height,ut.depth,Mt,At.data)}else e.compressedTexImage3D(i.TEXTURE_2D_ARRAY,nt,qt,At.width,At.height,ut.depth,0,At.data,0,0);else console.warn("THREE.WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()");else jt?B&&e.texSubImage3D(i.TEXTURE_2D_ARRAY,nt,0,0,0,At.width,At.height,ut.depth,Mt,Wt,At.data):e.texImage3D(i.TEXTURE_2D_ARRAY,nt,qt,At.width,At.height,ut.depth,0,Mt,Wt,At.data)}else{jt&&Me&&e.texStorage2D(i.TEXTURE_2D,St,qt,re[0].width,re[0].height);for(let nt=0,at=re.length;nt<at;nt++)At=re[nt],M.format!==_i?Mt!==null?jt?B&&e.compressedTexSubImage2D(i.TEXTURE_2D,nt,0,0,At.width,At.height,Mt,At.data):e.compressedTexImage2D(i.TEXTURE_2D,nt,qt,At.width,At.height,0,At.data):console.warn("THREE.WebGLRenderer: Attempt to load unsupported compressed texture format in .uploadTexture()"):jt?B&&e.texSubImage2D(i.TEXTURE_2D,nt,0,0,At.width,At.height,Mt,Wt,At.data):e.texImage2D(i.TEXTURE_2D,nt,qt,At.width,At.height,0,Mt,Wt,At.data)}else if(M.isDataArrayTexture)if(jt){if(Me&&e.texStorage3D(i.TEXTURE_2D_ARRAY,St,qt,ut.width,ut.height,ut.depth),B)if(M.layerUpdates.size>0){let nt=om(ut.width,ut.height,M.format,M.type);for(let at of M.layerUpdates){let Rt=ut.data.subarray(at*nt/ut.data.BYTES_PER_ELEMENT,(at+1)*nt/ut.data.BYTES_PER_ELEMENT);e.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,at,ut.width,ut.height,1,Mt,Wt,Rt)}M.clearLayerUpdates()}else e.texSubImage3D(i.TEXTURE_2D_ARRAY,0,0,0,0,ut.width,ut.height,ut.depth,Mt,Wt,ut.data)}else e.texImage3D(i.TEXTURE_2D_ARRAY,0,qt,ut.width,ut.height,ut.depth,0,Mt,Wt,ut.data);else if(M.isData3DTexture)jt?(Me&&e.texStorage3D(i.TEXTURE_3D,St,qt,ut.width,ut.height,ut.depth),B&&e.texSubImage3D(i.TEXTURE_3D,0,0,0,0,ut.width,ut.height,ut.depth,Mt,Wt,ut.data)):e.texImage3D(i.TEXTURE_3D,0,qt,ut.width,ut.height,ut.depth,0,Mt,Wt,ut.data);else if(M.isFramebufferTexture){if(Me)if(jt)e.texStorage2D(i.TEXTURE_2D,St,qt,ut.width,ut.height);else{let nt=ut.width,at=ut.height;for(let Rt=0;Rt<St;Rt++)e.texImage2D(i.TEXTURE_2D,Rt,qt,nt,at,0,Mt,Wt,null),nt>>=1,at>>=1}}else if(re.length>0){if(jt&&Me){let nt=Tt(re[0]);e.texStorage2D(i.TEXTURE_2D,St,qt,nt.width,nt.height)}for(let nt=0,at=re.length;nt<at;nt++)At=re[nt],jt?B&&e.texSubImage2D(i.TEXTURE_2D,nt,0,0,Mt,Wt,At):e.texImage2D(i.TEXTURE_2D,nt,qt,Mt,Wt,At);M.generateMipmaps=!1}else if(jt){if(Me){let nt=Tt(ut);e.texStorage2D(i.TEXTURE_2D,St,qt,nt.width,nt.height)}B&&e.texSubImage2D(i.TEXTURE_2D,0,0,0,Mt,Wt,ut)}else e.texImage2D(i.TEXTURE_2D,0,qt,Mt,Wt,ut);m(M)&&d(rt),kt.__version=it.version,M.onUpdate&&M.onUpdate(M)}P.__version=M.version}function ht(P,M,V){if(M.image.length!==6)return;let rt=Yt(P,M),et=M.source;e.bindTexture(i.TEXTURE_CUBE_MAP,P.__webglTexture,i.TEXTURE0+V);let it=n.get(et);if(et.version!==it.__version||rt===!0){e.activeTexture(i.TEXTURE0+V);let kt=ye.getPrimaries(ye.workingColorSpace),vt=M.colorSpace===xs?null:ye.getPrimaries(M.colorSpace),wt=M.colorSpace===xs||kt===vt?i.NONE:i.BROWSER_DEFAULT_WEBGL;i.pixelStorei(i.UNPACK_FLIP_Y_WEBGL,M.flipY),i.pixelStorei(i.UNPACK_PREMULTIPLY_ALPHA_WEBGL,M.premultiplyAlpha),i.pixelStorei(i.UNPACK_ALIGNMENT,M.unpackAlignment),i.pixelStorei(i.UNPACK_COLORSPACE_CONVERSION_WEBGL,wt);let Kt=M.isCompressedTexture||M.image[0].isCompressedTexture,ut=M.image[0]&&M.image[0].isDataTexture,Mt=[];for(let at=0;at<6;at++)!Kt&&!ut?Mt[at]=g(M.image[at],!0,s.maxCubemapSize):Mt[at]=ut?M.image[at].image:M.image[at],Mt[at]=me(M,Mt[at]);let Wt=Mt[0],qt=r.convert(M.format,M.colorSpace),At=r.convert(M.type),re=v(M.internalFormat,qt,At,M.colorSpace),jt=M.isVideoTexture!==!0,Me=it.__version===void 0||rt===!0,B=et.dataReady,St=I(M,Wt);dt(i.TEXTURE_CUBE_MAP,M);let nt;if(Kt){jt&&Me&&e.texStorage2D(i.TEXTURE_CUBE_MAP,St,re,Wt.width,Wt.height);for(let at=0;at<6;at++){nt=Mt[at].mipmaps;for(let Rt=0;Rt<nt.length;Rt++){let Ct=nt[Rt];M.format!==_i?qt!==null?jt?B&&e.compressedTexSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,Rt,0,0,Ct.width,Ct.height,qt,Ct.data):e.compressedTexImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,Rt,re,Ct.width,Ct.height,0,Ct.data):console.warn("THREE.WebGLRenderer: Attempt to load unsupported compressed texture format in .setTextureCube()"):jt?B&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,Rt,0,0,Ct.width,Ct.height,qt,At,Ct.data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,Rt,re,Ct.width,Ct.height,0,qt,At,Ct.data)}}}else{if(nt=M.mipmaps,jt&&Me){nt.length>0&&St++;let at=Tt(Mt[0]);e.texStorage2D(i.TEXTURE_CUBE_MAP,St,re,at.width,at.height)}for(let at=0;at<6;at++)if(ut){jt?B&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,0,0,0,Mt[at].width,Mt[at].height,qt,At,Mt[at].data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,0,re,Mt[at].width,Mt[at].height,0,qt,At,Mt[at].data);for(let Rt=0;Rt<nt.length;Rt++){let ne=nt[Rt].image[at].image;jt?B&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,Rt+1,0,0,ne.width,ne.height,qt,At,ne.data):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,Rt+1,re,ne.width,ne.height,0,qt,At,ne.data)}}else{jt?B&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,0,0,0,qt,At,Mt[at]):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,0,re,qt,At,Mt[at]);for(let Rt=0;Rt<nt.length;Rt++){let Ct=nt[Rt];jt?B&&e.texSubImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,Rt+1,0,0,qt,At,Ct.image[at]):e.texImage2D(i.TEXTURE_CUBE_MAP_POSITIVE_X+at,Rt+1,re,qt,At,Ct.image[at])}}}m(M)&&d(i.TEXTURE_CUBE_MAP),it.__version=et.version,M.onUpdate&&M.onUpdate(M)}P.__version=M.version}function Bt(P,M,V,rt,et,it){let kt=r.convert(V.format,V.colorSpace),vt=r.convert(V.type),wt=v(V.internalFormat,kt,vt,V.colorSpace),Kt=n.get(M),ut=n.get(V);if(ut.__renderTarget=M,!Kt.__hasExternalTextures){let Mt=Math.max(1,M.width>>it),Wt=Math.max(1,M.height>>it);et===i.TEXTURE_3D||et===i.TEXTURE_2D_ARRAY?e.texImage3D(et,it,wt,Mt,Wt,M.depth,0,kt,vt,null):e.texImage2D(et,it,wt,Mt,Wt,0,kt,vt,null)}e.bindFramebuffer(i.FRAMEBUFFER,P),$t(M)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,rt,et,ut.__webglTexture,0,Qt(M)):(et===i.TEXTURE_2D||et>=i.TEXTURE_CUBE_MAP_POSITIVE_X&&et<=i.TEXTURE_CUBE_MAP_NEGATIVE_Z)&&i.framebufferTexture2D(i.FRAMEBUFFER,rt,et,ut.__webglTexture,it),e.bindFramebuffer(i.FRAMEBUFFER,null)}function pt(P,M,V){if(i.bindRenderbuffer(i.RENDERBUFFER,P),M.depthBuffer){let rt=M.depthTexture,et=rt&&rt.isDepthTexture?rt.type:null,it=y(M.stencilBuffer,et),kt=M.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,vt=Qt(M);$t(M)?a.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,vt,it,M.width,M.height):V?i.renderbufferStorageMultisample(i.RENDERBUFFER,vt,it,M.width,M.height):i.renderbufferStorage(i.RENDERBUFFER,it,M.width,M.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,kt,i.RENDERBUFFER,P)}else{let rt=M.textures;for(let et=0;et<rt.length;et++){let it=rt[et],kt=r.convert(it.format,it.colorSpace),vt=r.convert(it.type),wt=v(it.internalFormat,kt,vt,it.colorSpace),Kt=Qt(M);V&&$t(M)===!1?i.renderbufferStorageMultisample(i.RENDERBUFFER,Kt,wt,M.width,M.height):$t(M)?a.renderbufferStorageMultisampleEXT(i.RENDERBUFFER,Kt,wt,M.width,M.height):i.renderbufferStorage(i.RENDERBUFFER,wt,M.width,M.height)}}i.bindRenderbuffer(i.RENDERBUFFER,null)}function zt(P,M){if(M&&M.isWebGLCubeRenderTarget)throw new Error("Depth Texture with cube render targets is not supported");if(e.bindFramebuffer(i.FRAMEBUFFER,P),!(M.depthTexture&&M.depthTexture.isDepthTexture))throw new Error("renderTarget.depthTexture must be an instance of THREE.DepthTexture");let rt=n.get(M.depthTexture);rt.__renderTarget=M,(!rt.__webglTexture||M.depthTexture.image.width!==M.width||M.depthTexture.image.height!==M.height)&&(M.depthTexture.image.width=M.width,M.depthTexture.image.height=M.height,M.depthTexture.needsUpdate=!0),$(M.depthTexture,0);let et=rt.__webglTexture,it=Qt(M);if(M.depthTexture.format===Xr)$t(M)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,i.DEPTH_ATTACHMENT,i.TEXTURE_2D,et,0,it):i.framebufferTexture2D(i.FRAMEBUFFER,i.DEPTH_ATTACHMENT,i.TEXTURE_2D,et,0);else if(M.depthTexture.format===jr)$t(M)?a.framebufferTexture2DMultisampleEXT(i.FRAMEBUFFER,i.DEPTH_STENCIL_ATTACHMENT,i.TEXTURE_2D,et,0,it):i.framebufferTexture2D(i.FRAMEBUFFER,i.DEPTH_STENCIL_ATTACHMENT,i.TEXTURE_2D,et,0);else throw new Error("Unknown depthTexture format")}function j(P){let M=n.get(P),V=P.isWebGLCubeRenderTarget===!0;if(M.__boundDepthTexture!==P.depthTexture){let rt=P.depthTexture;if(M.__depthDisposeCallback&&M.__depthDisposeCallback(),rt){let et=()=>{delete M.__boundDepthTexture,delete M.__depthDisposeCallback,rt.removeEventListener("dispose",et)};rt.addEventListener("dispose",et),M.__depthDisposeCallback=et}M.__boundDepthTexture=rt}if(P.depthTexture&&!M.__autoAllocateDepthBuffer){if(V)throw new Error("target.depthTexture not supported in Cube render targets");zt(M.__webglFramebuffer,P)}else if(V){M.__webglDepthbuffer=[];for(let rt=0;rt<6;rt++)if(e.bindFramebuffer(i.FRAMEBUFFER,M.__webglFramebuffer[rt]),M.__webglDepthbuffer[rt]===void 0)M.__webglDepthbuffer[rt]=i.createRenderbuffer(),pt(M.__webglDepthbuffer[rt],P,!1);else{let et=P.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,it=M.__webglDepthbuffer[rt];i.bindRenderbuffer(i.RENDERBUFFER,it),i.framebufferRenderbuffer(i.FRAMEBUFFER,et,i.RENDERBUFFER,it)}}else if(e.bindFramebuffer(i.FRAMEBUFFER,M.__webglFramebuffer),M.__webglDepthbuffer===void 0)M.__webglDepthbuffer=i.createRenderbuffer(),pt(M.__webglDepthbuffer,P,!1);else{let rt=P.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,et=M.__webglDepthbuffer;i.bindRenderbuffer(i.RENDERBUFFER,et),i.framebufferRenderbuffer(i.FRAMEBUFFER,rt,i.RENDERBUFFER,et)}e.bindFramebuffer(i.FRAMEBUFFER,null)}function st(P,M,V){let rt=n.get(P);M!==void 0&&Bt(rt.__webglFramebuffer,P,P.texture,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,0),V!==void 0&&j(P)}function It(P){let M=P.texture,V=n.get(P),rt=n.get(M);P.addEventListener("dispose",R);let et=P.textures,it=P.isWebGLCubeRenderTarget===!0,kt=et.length>1;if(kt||(rt.__webglTexture===void 0&&(rt.__webglTexture=i.createTexture()),rt.__version=M.version,o.memory.textures++),it){V.__webglFramebuffer=[];for(let vt=0;vt<6;vt++)if(M.mipmaps&&M.mipmaps.length>0){V.__webglFramebuffer[vt]=[];for(let wt=0;wt<M.mipmaps.length;wt++)V.__webglFramebuffer[vt][wt]=i.createFramebuffer()}else V.__webglFramebuffer[vt]=i.createFramebuffer()}else{if(M.mipmaps&&M.mipmaps.length>0){V.__webglFramebuffer=[];for(let vt=0;vt<M.mipmaps.length;vt++)V.__webglFramebuffer[vt]=i.createFramebuffer()}else V.__webglFramebuffer=i.createFramebuffer();if(kt)for(let vt=0,wt=et.length;vt<wt;vt++){let Kt=n.get(et[vt]);Kt.__webglTexture===void 0&&(Kt.__webglTexture=i.createTexture(),o.memory.textures++)}if(P.samples>0&&$t(P)===!1){V.__webglMultisampledFramebuffer=i.createFramebuffer(),V.__webglColorRenderbuffer=[],e.bindFramebuffer(i.FRAMEBUFFER,V.__webglMultisampledFramebuffer);for(let vt=0;vt<et.length;vt++){let wt=et[vt];V.__webglColorRenderbuffer[vt]=i.createRenderbuffer(),i.bindRenderbuffer(i.RENDERBUFFER,V.__webglColorRenderbuffer[vt]);let Kt=r.convert(wt.format,wt.colorSpace),ut=r.convert(wt.type),Mt=v(wt.internalFormat,Kt,ut,wt.colorSpace,P.isXRRenderTarget===!0),Wt=Qt(P);i.renderbufferStorageMultisample(i.RENDERBUFFER,Wt,Mt,P.width,P.height),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+vt,i.RENDERBUFFER,V.__webglColorRenderbuffer[vt])}i.bindRenderbuffer(i.RENDERBUFFER,null),P.depthBuffer&&(V.__webglDepthRenderbuffer=i.createRenderbuffer(),pt(V.__webglDepthRenderbuffer,P,!0)),e.bindFramebuffer(i.FRAMEBUFFER,null)}}if(it){e.bindTexture(i.TEXTURE_CUBE_MAP,rt.__webglTexture),dt(i.TEXTURE_CUBE_MAP,M);for(let vt=0;vt<6;vt++)if(M.mipmaps&&M.mipmaps.length>0)for(let wt=0;wt<M.mipmaps.length;wt++)Bt(V.__webglFramebuffer[vt][wt],P,M,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+vt,wt);else Bt(V.__webglFramebuffer[vt],P,M,i.COLOR_ATTACHMENT0,i.TEXTURE_CUBE_MAP_POSITIVE_X+vt,0);m(M)&&d(i.TEXTURE_CUBE_MAP),e.unbindTexture()}else if(kt){for(let vt=0,wt=et.length;vt<wt;vt++){let Kt=et[vt],ut=n.get(Kt);e.bindTexture(i.TEXTURE_2D,ut.__webglTexture),dt(i.TEXTURE_2D,Kt),Bt(V.__webglFramebuffer,P,Kt,i.COLOR_ATTACHMENT0+vt,i.TEXTURE_2D,0),m(Kt)&&d(i.TEXTURE_2D)}e.unbindTexture()}else{let vt=i.TEXTURE_2D;if((P.isWebGL3DRenderTarget||P.isWebGLArrayRenderTarget)&&(vt=P.isWebGL3DRenderTarget?i.TEXTURE_3D:i.TEXTURE_2D_ARRAY),e.bindTexture(vt,rt.__webglTexture),dt(vt,M),M.mipmaps&&M.mipmaps.length>0)for(let wt=0;wt<M.mipmaps.length;wt++)Bt(V.__webglFramebuffer[wt],P,M,i.COLOR_ATTACHMENT0,vt,wt);else Bt(V.__webglFramebuffer,P,M,i.COLOR_ATTACHMENT0,vt,0);m(M)&&d(vt),e.unbindTexture()}P.depthBuffer&&j(P)}function yt(P){let M=P.textures;for(let V=0,rt=M.length;V<rt;V++){let et=M[V];if(m(et)){let it=S(P),kt=n.get(et).__webglTexture;e.bindTexture(it,kt),d(it),e.unbindTexture()}}}let Zt=[],N=[];function le(P){if(P.samples>0){if($t(P)===!1){let M=P.textures,V=P.width,rt=P.height,et=i.COLOR_BUFFER_BIT,it=P.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT,kt=n.get(P),vt=M.length>1;if(vt)for(let wt=0;wt<M.length;wt++)e.bindFramebuffer(i.FRAMEBUFFER,kt.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+wt,i.RENDERBUFFER,null),e.bindFramebuffer(i.FRAMEBUFFER,kt.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+wt,i.TEXTURE_2D,null,0);e.bindFramebuffer(i.READ_FRAMEBUFFER,kt.__webglMultisampledFramebuffer),e.bindFramebuffer(i.DRAW_FRAMEBUFFER,kt.__webglFramebuffer);for(let wt=0;wt<M.length;wt++){if(P.resolveDepthBuffer&&(P.depthBuffer&&(et|=i.DEPTH_BUFFER_BIT),P.stencilBuffer&&P.resolveStencilBuffer&&(et|=i.STENCIL_BUFFER_BIT)),vt){i.framebufferRenderbuffer(i.READ_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.RENDERBUFFER,kt.__webglColorRenderbuffer[wt]);let Kt=n.get(M[wt]).__webglTexture;i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0,i.TEXTURE_2D,Kt,0)}i.blitFramebuffer(0,0,V,rt,0,0,V,rt,et,i.NEAREST),l===!0&&(Zt.length=0,N.length=0,Zt.push(i.COLOR_ATTACHMENT0+wt),P.depthBuffer&&P.resolveDepthBuffer===!1&&(Zt.push(it),N.push(it),i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,N)),i.invalidateFramebuffer(i.READ_FRAMEBUFFER,Zt))}if(e.bindFramebuffer(i.READ_FRAMEBUFFER,null),e.bindFramebuffer(i.DRAW_FRAMEBUFFER,null),vt)for(let wt=0;wt<M.length;wt++){e.bindFramebuffer(i.FRAMEBUFFER,kt.__webglMultisampledFramebuffer),i.framebufferRenderbuffer(i.FRAMEBUFFER,i.COLOR_ATTACHMENT0+wt,i.RENDERBUFFER,kt.__webglColorRenderbuffer[wt]);let Kt=n.get(M[wt]).__webglTexture;e.bindFramebuffer(i.FRAMEBUFFER,kt.__webglFramebuffer),i.framebufferTexture2D(i.DRAW_FRAMEBUFFER,i.COLOR_ATTACHMENT0+wt,i.TEXTURE_2D,Kt,0)}e.bindFramebuffer(i.DRAW_FRAMEBUFFER,kt.__webglMultisampledFramebuffer)}else if(P.depthBuffer&&P.resolveDepthBuffer===!1&&l){let M=P.stencilBuffer?i.DEPTH_STENCIL_ATTACHMENT:i.DEPTH_ATTACHMENT;i.invalidateFramebuffer(i.DRAW_FRAMEBUFFER,[M])}}}function Qt(P){return Math.min(s.maxSamples,P.samples)}function $t(P){let M=n.get(P);return P.samples>0&&t.has("WEBGL_multisampled_render_to_texture")===!0&&M.__useRenderToTexture!==!1}function Dt(P){let M=o.render.frame;u.get(P)!==M&&(u.set(P,M),P.update())}function me(P,M){let V=P.colorSpace,rt=P.format,et=P.type;return P.isCompressedTexture===!0||P.isVideoTexture===!0||V!==ro&&V!==xs&&(ye.getTransfer(V)===Ce?(rt!==_i||et!==ji)&&console.warn("THREE.WebGLTextures: sRGB encoded textures have to use RGBAFormat and UnsignedByteType."):console.error("THREE.WebGLTextures: Unsupported texture color space:",V)),M}function Tt(P){return typeof HTMLImageElement<"u"&&P instanceof HTMLImageElement?(c.width=P.naturalWidth||P.width,c.height=P.naturalHeight||P.height):typeof VideoFrame<"u"&&P instanceof VideoFrame?(c.width=P.displayWidth,c.height=P.displayHeight):(c.width=P.width,c.height=P.height),c}this.allocateTextureUnit=F,this.resetTextureUnits=O,this.setTexture2D=$,this.setTexture2DArray=W,this.setTexture3D=Z,this.setTextureCube=J,this.rebindTextures=st,this.setupRenderTarget=It,this.updateRenderTargetMipmap=yt,this.updateMultisampleRenderTarget=le,this.setupDepthRenderbuffer=j,this.setupFrameBufferTexture=Bt,this.useMultisampledRTT=$t}function pb(i,t){function e(n,s=xs){let r,o=ye.getTransfer(s);if(n===ji)return i.UNSIGNED_BYTE;if(n===Tu)return i.UNSIGNED_SHORT_4_4_4_4;if(n===Au)return i.UNSIGNED_SHORT_5_5_5_1;if(n===xm)return i.UNSIGNED_INT_5_9_9_9_REV;if(n===gm)return i.BYTE;if(n===_m)return i.SHORT;if(n===Bo)return i.UNSIGNED_SHORT;if(n===Eu)return i.INT;if(n===Ks)return i.UNSIGNED_INT;if(n===$i)return i.FLOAT;if(n===Xo)return i.HALF_FLOAT;if(n===ym)return i.ALPHA;if(n===vm)return i.RGB;if(n===_i)return i.RGBA;if(n===Mm)return i.LUMINANCE;if(n===Sm)return i.LUMINANCE_ALPHA;if(n===Xr)return i.DEPTH_COMPONENT;if(n===jr)return i.DEPTH_STENCIL;if(n===bm)return i.RED;if(n===Cu)return i.RED_INTEGER;if(n===wm)return i.RG;if(n===Ru)return i.RG_INTEGER;if(n===Pu)return i.RGBA_INTEGER;if(n===$a||n===Za||n===Ja||n===Ka)if(o===Ce)if(r=t.get("WEBGL_compressed_texture_s3tc_srgb"),r!==null){if(n===$a)return r.COMPRESSED_SRGB_S3TC_DXT1_EXT;if(n===Za)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT1_EXT;if(n===Ja)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT3_EXT;if(n===Ka)return r.COMPRESSED_SRGB_ALPHA_S3TC_DXT5_EXT}else return null;else if(r=t.get("WEBGL_compressed_texture_s3tc"),r!==null){if(n===$a)return r.COMPRESSED_RGB_S3TC_DXT1_EXT;if(n===Za)return r.COMPRESSED_RGBA_S3TC_DXT1_EXT;if(n===Ja)return r.COMPRESSED_RGBA_S3TC_DXT3_EXT;if(n===Ka)return r.COMPRESSED_RGBA_S3TC_DXT5_EXT}else return null;if(n===bh||n===wh||n===Eh||n===Th)if(r=t.get("WEBGL_compressed_texture_pvrtc"),r!==null){if(n===bh)return r.COMPRESSED_RGB_PVRTC_4BPPV1_IMG;if(n===wh)return r.COMPRESSED_RGB_PVRTC_2BPPV1_IMG;if(n===Eh)return r.COMPRESSED_RGBA_PVRTC_4BPPV1_IMG;if(n===Th)return r.COMPRESSED_RGBA_PVRTC_2BPPV1_IMG}else return null;if(n===Ah||n===Ch||n===Rh)if(r=t.get("WEBGL_compressed_texture_etc"),r!==null){if(n===Ah||n===Ch)return o===Ce?r.COMPRESSED_SRGB8_ETC2:r.COMPRESSED_RGB8_ETC2;if(n===Rh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ETC2_EAC:r.COMPRESSED_RGBA8_ETC2_EAC}else return null;if(n===Ph||n===Ih||n===Lh||n===Dh||n===Uh||n===Nh||n===Oh||n===Fh||n===Bh||n===kh||n===zh||n===Vh||n===Hh||n===Gh)if(r=t.get("WEBGL_compressed_texture_astc"),r!==null){if(n===Ph)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_4x4_KHR:r.COMPRESSED_RGBA_ASTC_4x4_KHR;if(n===Ih)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x4_KHR:r.COMPRESSED_RGBA_ASTC_5x4_KHR;if(n===Lh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_5x5_KHR:r.COMPRESSED_RGBA_ASTC_5x5_KHR;if(n===Dh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x5_KHR:r.COMPRESSED_RGBA_ASTC_6x5_KHR;if(n===Uh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_6x6_KHR:r.COMPRESSED_RGBA_ASTC_6x6_KHR;if(n===Nh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x5_KHR:r.COMPRESSED_RGBA_ASTC_8x5_KHR;if(n===Oh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x6_KHR:r.COMPRESSED_RGBA_ASTC_8x6_KHR;if(n===Fh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_8x8_KHR:r.COMPRESSED_RGBA_ASTC_8x8_KHR;if(n===Bh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x5_KHR:r.COMPRESSED_RGBA_ASTC_10x5_KHR;if(n===kh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x6_KHR:r.COMPRESSED_RGBA_ASTC_10x6_KHR;if(n===zh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x8_KHR:r.COMPRESSED_RGBA_ASTC_10x8_KHR;if(n===Vh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_10x10_KHR:r.COMPRESSED_RGBA_ASTC_10x10_KHR;if(n===Hh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x10_KHR:r.COMPRESSED_RGBA_ASTC_12x10_KHR;if(n===Gh)return o===Ce?r.COMPRESSED_SRGB8_ALPHA8_ASTC_12x12_KHR:r.COMPRESSED_RGBA_ASTC_12x12_KHR}else return null;if(n===ja||n===Wh||n===Xh)if(r=t.get("EXT_texture_compression_bptc"),r!==null){if(n===ja)return o===Ce?r.COMPRESSED_SRGB_ALPHA_BPTC_UNORM_EXT:r.COMPRESSED_RGBA_BPTC_UNORM_EXT;if(n===Wh)return r.COMPRESSED_RGB_BPTC_SIGNED_FLOAT_EXT;if(n===Xh)return r.COMPRESSED_RGB_BPTC_UNSIGNED_FLOAT_EXT}else return null;if(n===Em||n===qh||n===Yh||n===$h)if(r=t.get("EXT_texture_compression_rgtc"),r!==null){if(n===ja)return r.COMPRESSED_RED_RGTC1_EXT;if(n===qh)return r.COMPRESSED_SIGNED_RED_RGTC1_EXT;if(n===Yh)return r.COMPRESSED_RED_GREEN_RGTC2_EXT;if(n===$h)return r.COMPRESSED_SIGNED_RED_GREEN_RGTC2_EXT}else return null;return n===Kr?i.UNSIGNED_INT_24_8:i[n]!==void 0?i[n]:null}return{convert:e}}var cu=class extends An{constructor(t=[]){super(),this.isArrayCamera=!0,this.cameras=t}},Ji=class extends Rn{constructor(){super(),this.isGroup=!0,this.type="Group"}},mb={type:"move"},Fo=class{constructor(){this._targetRay=null,this._grip=null,this._hand=null}getHandSpace(){return this._hand===null&&(this._hand=new Ji,this._hand.matrixAutoUpdate=!1,this._hand.visible=!1,this._hand.joints={},this._hand.inputState={pinching:!1}),this._hand}getTargetRaySpace(){return this._targetRay===null&&(this._targetRay=new Ji,this._targetRay.matrixAutoUpdate=!1,this._targetRay.visible=!1,this._targetRay.hasLinearVelocity=!1,this._targetRay.linearVelocity=new Y,this._targetRay.hasAngularVelocity=!1,this._targetRay.angularVelocity=new Y),this._targetRay}getGripSpace(){return this._grip===null&&(this._grip=new Ji,this._grip.matrixAutoUpdate=!1,this._grip.visible=!1,this._grip.hasLinearVelocity=!1,this._grip.linearVelocity=new Y,this._grip.hasAngularVelocity=!1,this._grip.angularVelocity=new Y),this._grip}dispatchEvent(t){return this._targetRay!==null&&this._targetRay.dispatchEvent(t),this._grip!==null&&this._grip.dispatchEvent(t),this._hand!==null&&this._hand.dispatchEvent(t),this}connect(t){if(t&&t.hand){let e=this._hand;if(e)for(let n of t.hand.values())this._getHandJoint(e,n)}return this.dispatchEvent({type:"connected",data:t}),this}disconnect(t){return this.dispatchEvent({type:"disconnected",data:t}),this._targetRay!==null&&(this._targetRay.visible=!1),this._grip!==null&&(this._grip.visible=!1),this._hand!==null&&(this._hand.visible=!1),this}update(t,e,n){let s=null,r=null,o=null,a=this._targetRay,l=this._grip,c=this._hand;if(t&&e.session.visibilityState!=="visible-blurred"){if(c&&t.hand){o=!0;for(let g of t.hand.values()){let m=e.getJointPose(g,n),d=this._getHandJoint(c,g);m!==null&&(d.matrix.fromArray(m.transform.matrix),d.matrix.decompose(d.position,d.rotation,d.scale),d.matrixWorldNeedsUpdate=!0,d.jointRadius=m.radius),d.visible=m!==null}let u=c.joints["index-finger-tip"],f=c.joints["thumb-tip"],h=u.position.distanceTo(f.position),p=.02,_=.005;c.inputState.pinching&&h>p+_?(c.inputState.pinching=!1,this.dispatchEvent({type:"pinchend",handedness:t.handedness,target:this})):!c.inputState.pinching&&h<=p-_&&(c.inputState.pinching=!0,this.dispatchEvent({type:"pinchstart",handedness:t.handedness,target:this}))}else l!==null&&t.gripSpace&&(r=e.getPose(t.gripSpace,n),r!==null&&(l.matrix.fromArray(r.transform.matrix),l.matrix.decompose(l.position,l.rotation,l.scale),l.matrixWorldNeedsUpdate=!0,r.linearVelocity?(l.hasLinearVelocity=!0,l.linearVelocity.copy(r.linearVelocity)):l.hasLinearVelocity=!1,r.angularVelocity?(l.hasAngularVelocity=!0,l.angularVelocity.copy(r.angularVelocity)):l.hasAngularVelocity=!1));a!==null&&(s=e.getPose(t.targetRaySpace,n),s===null&&r!==null&&(s=r),s!==null&&(a.matrix.fromArray(s.transform.matrix),a.matrix.decompose(a.position,a.rotation,a.scale),a.matrixWorldNeedsUpdate=!0,s.linearVelocity?(a.hasLinearVelocity=!0,a.linearVelocity.copy(s.linearVelocity)):a.hasLinearVelocity=!1,s.angularVelocity?(a.hasAngularVelocity=!0,a.angularVelocity.copy(s.angularVelocity)):a.hasAngularVelocity=!1,this.dispatchEvent(mb)))}return a!==null&&(a.visible=s!==null),l!==null&&(l.visible=r!==null),c!==null&&(c.visible=o!==null),this}_getHandJoint(t,e){if(t.joints[e.jointName]===void 0){let n=new Ji;n.matrixAutoUpdate=!1,n.visible=!1,t.joints[e.jointName]=n,t.add(n)}return t.joints[e.jointName]}},gb=`
void main() {

	gl_Position = vec4( position, 1.0 );

}`,_b=`
uniform sampler2DArray depthColor;
uniform float depthWidth;
uniform float depthHeight;

void main() {

	vec2 coord = vec2( gl_FragCoord.x / depthWidth, gl_FragCoord.y / depthHeight );

	if ( coord.x >= 1.0 ) {

		gl_FragDepth = texture( depthColor, vec3( coord.x - 1.0, coord.y, 1 ) ).r;

	} else {

		gl_FragDepth = texture( depthColor, vec3( coord.x, coord.y, 0 ) ).r;

	}

}`,hu=class{constructor(){this.texture=null,this.mesh=null,this.depthNear=0,this.depthFar=0}init(t,e,n){if(this.texture===null){let s=new Fn,r=t.properties.get(s);r.__webglTexture=e.texture,(e.depthNear!=n.depthNear||e.depthFar!=n.depthFar)&&(this.depthNear=e.depthNear,this.depthFar=e.depthFar),this.texture=s}}getMesh(t){if(this.texture!==null&&this.mesh===null){let e=t.cameras[0].viewport,n=new Di({vertexShader:gb,fragmentShader:_b,uniforms:{depthColor:{value:this.texture},depthWidth:{value:e.z},depthHeight:{value:e.w}}});this.mesh=new Cn(new cl(20,20),n)}return this.mesh}reset(){this.texture=null,this.mesh=null}getDepthTexture(){return this.texture}},uu=class extends Qi{constructor(t,e){super();let n=this,s=null,r=1,o=null,a="local-floor",l=1,c=null,u=null,f=null,h=null,p=null,_=null,g=new hu,m=e.getContextAttributes(),d=null,S=null,v=[],y=[],I=new se,C=null,R=new An;R.viewport=new He;let L=new An;L.viewport=new He;let E=[R,L],b=new cu,A=null,O=null;this.cameraAutoUpdate=!0,this.enabled=!1,this.isPresenting=!1,this.getController=function(Q){let ht=v[Q];return ht===void 0&&(ht=new Fo,v[Q]=ht),ht.getTargetRaySpace()},this.getControllerGrip=function(Q){let ht=v[Q];return ht===void 0&&(ht=new Fo,v[Q]=ht),ht.getGripSpace()},this.getHand=function(Q){let ht=v[Q];return ht===void 0&&(ht=new Fo,v[Q]=ht),ht.getHandSpace()};function F(Q){let ht=y.indexOf(Q.inputSource);if(ht===-1)return;let Bt=v[ht];Bt!==void 0&&(Bt.update(Q.inputSource,Q.frame,c||o),Bt.dispatchEvent({type:Q.type,data:Q.inputSource}))}function G(){s.removeEventListener("select",F),s.removeEventListener("selectstart",F),s.removeEventListener("selectend",F),s.removeEventListener("squeeze",F),s.removeEventListener("squeezestart",F),s.removeEventListener("squeezeend",F),s.removeEventListener("end",G),s.removeEventListener("inputsourceschange",$);for(let Q=0;Q<v.length;Q++){let ht=y[Q];ht!==null&&(y[Q]=null,v[Q].disconnect(ht))}A=null,O=null,g.reset(),t.setRenderTarget(d),p=null,h=null,f=null,s=null,S=null,Yt.stop(),n.isPresenting=!1,t.setPixelRatio(C),t.setSize(I.width,I.height,!1),n.dispatchEvent({type:"sessionend"})}this.setFramebufferScaleFactor=function(Q){r=Q,n.isPresenting===!0&&console.warn("THREE.WebXRManager: Cannot change framebuffer scale while presenting.")},this.setReferenceSpaceType=function(Q){a=Q,n.isPresenting===!0&&console.warn("THREE.WebXRManager: Cannot change reference space type while presenting.")},this.getReferenceSpace=function(){return c||o},this.setReferenceSpace=function(Q){c=Q},this.getBaseLayer=function(){return h!==null?h:p},this.getBinding=function(){return f},this.getFrame=function(){return _},this.getSession=function(){return s},this.setSession=async function(Q){if(s=Q,s!==null){if(d=t.getRenderTarget(),s.addEventListener("select",F),s.addEventListener("selectstart",F),s.addEventListener("selectend",F),s.addEventListener("squeeze",F),s.addEventListener("squeezestart",F),s.addEventListener("squeezeend",F),s.addEventListener("end",G),s.addEventListener("inputsourceschange",$),m.xrCompatible!==!0&&await e.makeXRCompatible(),C=t.getPixelRatio(),t.getSize(I),s.renderState.layers===void 0){let ht={antialias:m.antialias,alpha:!0,depth:m.depth,stencil:m.stencil,framebufferScaleFactor:r};p=new XRWebGLLayer(s,e,ht),s.updateRenderState({baseLayer:p}),t.setPixelRatio(1),t.setSize(p.framebufferWidth,p.framebufferHeight,!1),S=new ts(p.framebufferWidth,p.framebufferHeight,{format:_i,type:ji,colorSpace:t.outputColorSpace,stencilBuffer:m.stencil})}else{let ht=null,Bt=null,pt=null;m.depth&&(pt=m.stencil?e.DEPTH24_STENCIL8:e.DEPTH_COMPONENT24,ht=m.stencil?jr:Xr,Bt=m.stencil?Kr:Ks);let zt={colorFormat:e.RGBA8,depthFormat:pt,scaleFactor:r};f=new XRWebGLBinding(s,e),h=f.createProjectionLayer(zt),s.updateRenderState({layers:[h]}),t.setPixelRatio(1),t.setSize(h.textureWidth,h.textureHeight,!1),S=new ts(h.textureWidth,h.textureHeight,{format:_i,type:ji,depthTexture:new fl(h.textureWidth,h.textureHeight,Bt,void 0,void 0,void 0,void 0,void 0,void 0,ht),stencilBuffer:m.stencil,colorSpace:t.outputColorSpace,samples:m.antialias?4:0,resolveDepthBuffer:h.ignoreDepthValues===!1})}S.isXRRenderTarget=!0,this.setFoveation(l),c=null,o=await s.requestReferenceSpace(a),Yt.setContext(s),Yt.start(),n.isPresenting=!0,n.dispatchEvent({type:"sessionstart"})}},this.getEnvironmentBlendMode=function(){if(s!==null)return s.environmentBlendMode},this.getDepthTexture=function(){return g.getDepthTexture()};function $(Q){for(let ht=0;ht<Q.removed.length;ht++){let Bt=Q.removed[ht],pt=y.indexOf(Bt);pt>=0&&(y[pt]=null,v[pt].disconnect(Bt))}for(let ht=0;ht<Q.added.length;ht++){let Bt=Q.added[ht],pt=y.indexOf(Bt);if(pt===-1){for(let j=0;j<v.length;j++)if(j>=y.length){y.push(Bt),pt=j;break}else if(y[j]===null){y[j]=Bt,pt=j;break}if(pt===-1)break}let zt=v[pt];zt&&zt.connect(Bt)}}let W=new Y,Z=new Y;function J(Q,ht,Bt){W.setFromMatrixPosition(ht.matrixWorld),Z.setFromMatrixPosition(Bt.matrixWorld);let pt=W.distanceTo(Z),zt=ht.projectionMatrix.elements,j=Bt.projectionMatrix.elements,st=zt[14]/(zt[10]-1),It=zt[14]/(zt[10]+1),yt=(zt[9]+1)/zt[5],Zt=(zt[9]-1)/zt[5],N=(zt[8]-1)/zt[0],le=(j[8]+1)/j[0],Qt=st*N,$t=st*le,Dt=pt/(-N+le),me=Dt*-N;if(ht.matrixWorld.decompose(Q.position,Q.quaternion,Q.scale),Q.translateX(me),Q.translateZ(Dt),Q.matrixWorld.compose(Q.position,Q.quaternion,Q.scale),Q.matrixWorldInverse.copy(Q.matrixWorld).invert(),zt[10]===-1)Q.projectionMatrix.copy(ht.projectionMatrix),Q.projectionMatrixInverse.copy(ht.projectionMatrixInverse);else{let Tt=st+Dt,P=It+Dt,M=Qt-me,V=$t+(pt-me),rt=yt*It/P*Tt,et=Zt*It/P*Tt;Q.projectionMatrix.makePerspective(M,V,rt,et,Tt,P),Q.projectionMatrixInverse.copy(Q.projectionMatrix).invert()}}function ct(Q,ht){ht===null?Q.matrixWorld.copy(Q.matrix):Q.matrixWorld.multiplyMatrices(ht.matrixWorld,Q.matrix),Q.matrixWorldInverse.copy(Q.matrixWorld).invert()}this.updateCamera=function(Q){if(s===null)return;let ht=Q.near,Bt=Q.far;g.texture!==null&&(g.depthNear>0&&(ht=g.depthNear),g.depthFar>0&&(Bt=g.depthFar)),b.near=L.near=R.near=ht,b.far=L.far=R.far=Bt,(A!==b.near||O!==b.far)&&(s.updateRenderState({depthNear:b.near,depthFar:b.far}),A=b.near,O=b.far),R.layers.mask=Q.layers.mask|2,L.layers.mask=Q.layers.mask|4,b.layers.mask=R.layers.mask|L.layers.mask;let pt=Q.parent,zt=b.cameras;ct(b,pt);for(let j=0;j<zt.length;j++)ct(zt[j],pt);zt.length===2?J(b,R,L):b.projectionMatrix.copy(R.projectionMatrix),lt(Q,b,pt)};function lt(Q,ht,Bt){Bt===null?Q.matrix.copy(ht.matrixWorld):(Q.matrix.copy(Bt.matrixWorld),Q.matrix.invert(),Q.matrix.multiply(ht.matrixWorld)),Q.matrix.decompose(Q.position,Q.quaternion,Q.scale),Q.updateMatrixWorld(!0),Q.projectionMatrix.copy(ht.projectionMatrix),Q.projectionMatrixInverse.copy(ht.projectionMatrixInverse),Q.isPerspectiveCamera&&(Q.fov=ko*2*Math.atan(1/Q.projectionMatrix.elements[5]),Q.zoom=1)}this.getCamera=function(){return b},this.getFoveation=function(){if(!(h===null&&p===null))return l},this.setFoveation=function(Q){l=Q,h!==null&&(h.fixedFoveation=Q),p!==null&&p.fixedFoveation!==void 0&&(p.fixedFoveation=Q)},this.hasDepthSensing=function(){return g.texture!==null},this.getDepthSensingMesh=function(){return g.getMesh(b)};let _t=null;function dt(Q,ht){if(u=ht.getViewerPose(c||o),_=ht,u!==null){let Bt=u.views;p!==null&&(t.setRenderTargetFramebuffer(S,p.framebuffer),t.setRenderTarget(S));let pt=!1;Bt.length!==b.cameras.length&&(b.cameras.length=0,pt=!0);for(let j=0;j<Bt.length;j++){let st=Bt[j],It=null;if(p!==null)It=p.getViewport(st);else{let Zt=f.getViewSubImage(h,st);It=Zt.viewport,j===0&&(t.setRenderTargetTextures(S,Zt.colorTexture,h.ignoreDepthValues?void 0:Zt.depthStencilTexture),t.setRenderTarget(S))}let yt=E[j];yt===void 0&&(yt=new An,yt.layers.enable(j),yt.viewport=new He,E[j]=yt),yt.matrix.fromArray(st.transform.matrix),yt.matrix.decompose(yt.position,yt.quaternion,yt.scale),yt.projectionMatrix.fromArray(st.projectionMatrix),yt.projectionMatrixInverse.copy(yt.projectionMatrix).invert(),yt.viewport.set(It.x,It.y,It.width,It.height),j===0&&(b.matrix.copy(yt.matrix),b.matrix.decompose(b.position,b.quaternion,b.scale)),pt===!0&&b.cameras.push(yt)}let zt=s.enabledFeatures;if(zt&&zt.includes("depth-sensing")){let j=f.getDepthInformation(Bt[0]);j&&j.isValid&&j.texture&&g.init(t,j,s.renderState)}}for(let Bt=0;Bt<v.length;Bt++){let pt=y[Bt],zt=v[Bt];pt!==null&&zt!==void 0&&zt.update(pt,ht,c||o)}_t&&_t(Q,ht),ht.detectedPlanes&&n.dispatchEvent({type:"planesdetected",data:ht}),_=null}let Yt=new Lm;Yt.setAnimationLoop(dt),this.setAnimationLoop=function(Q){_t=Q},this.dispose=function(){}}},Ws=new Li,xb=new Ge;function yb(i,t){function e(m,d){m.matrixAutoUpdate===!0&&m.updateMatrix(),d.value.copy(m.matrix)}function n(m,d){d.color.getRGB(m.fogColor.value,Im(i)),d.isFog?(m.fogNear.value=d.near,m.fogFar.value=d.far):d.isFogExp2&&(m.fogDensity.value=d.density)}function s(m,d,S,v,y){d.isMeshBasicMaterial||d.isMeshLambertMaterial?r(m,d):d.isMeshToonMaterial?(r(m,d),f(m,d)):d.isMeshPhongMaterial?(r(m,d),u(m,d)):d.isMeshStandardMaterial?(r(m,d),h(m,d),d.isMeshPhysicalMaterial&&p(m,d,y)):d.isMeshMatcapMaterial?(r(m,d),_(m,d)):d.isMeshDepthMaterial?r(m,d):d.isMeshDistanceMaterial?(r(m,d),g(m,d)):d.isMeshNormalMaterial?r(m,d):d.isLineBasicMaterial?(o(m,d),d.isLineDashedMaterial&&a(m,d)):d.isPointsMaterial?l(m,d,S,v):d.isSpriteMaterial?c(m,d):d.isShadowMaterial?(m.color.value.copy(d.color),m.opacity.value=d.opacity):d.isShaderMaterial&&(d.uniformsNeedUpdate=!1)}function r(m,d){m.opacity.value=d.opacity,d.color&&m.diffuse.value.copy(d.color),d.emissive&&m.emissive.value.copy(d.emissive).multiplyScalar(d.emissiveIntensity),d.map&&(m.map.value=d.map,e(d.map,m.mapTransform)),d.alphaMap&&(m.alphaMap.value=d.alphaMap,e(d.alphaMap,m.alphaMapTransform)),d.bumpMap&&(m.bumpMap.value=d.bumpMap,e(d.bumpMap,m.bumpMapTransform),m.bumpScale.value=d.bumpScale,d.side===Nn&&(m.bumpScale.value*=-1)),d.normalMap&&(m.normalMap.value=d.normalMap,e(d.normalMap,m.normalMapTransform),m.normalScale.value.copy(d.normalScale),d.side===Nn&&m.normalScale.value.negate()),d.displacementMap&&(m.displacementMap.value=d.displacementMap,e(d.displacementMap,m.displacementMapTransform),m.displacementScale.value=d.displacementScale,m.displacementBias.value=d.displacementBias),d.emissiveMap&&(m.emissiveMap.value=d.emissiveMap,e(d.emissiveMap,m.emissiveMapTransform)),d.specularMap&&(m.specularMap.value=d.specularMap,e(d.specularMap,m.specularMapTransform)),d.alphaTest>0&&(m.alphaTest.value=d.alphaTest);let S=t.get(d),v=S.envMap,y=S.envMapRotation;v&&(m.envMap.value=v,Ws.copy(y),Ws.x*=-1,Ws.y*=-1,Ws.z*=-1,v.isCubeTexture&&v.isRenderTargetTexture===!1&&(Ws.y*=-1,Ws.z*=-1),m.envMapRotation.value.setFromMatrix4(xb.makeRotationFromEuler(Ws)),m.flipEnvMap.value=v.isCubeTexture&&v.isRenderTargetTexture===!1?-1:1,m.reflectivity.value=d.reflectivity,m.ior.value=d.ior,m.refractionRatio.value=d.refractionRatio),d.lightMap&&(m.lightMap.value=d.lightMap,m.lightMapIntensity.value=d.lightMapIntensity,e(d.lightMap,m.lightMapTransform)),d.aoMap&&(m.aoMap.value=d.aoMap,m.aoMapIntensity.value=d.aoMapIntensity,e(d.aoMap,m.aoMapTransform))}function o(m,d){m.diffuse.value.copy(d.color),m.opacity.value=d.opacity,d.map&&(m.map.value=d.map,e(d.map,m.mapTransform))}function a(m,d){m.dashSize.value=d.dashSize,m.totalSize.value=d.dashSize+d.gapSize,m.scale.value=d.scale}function l(m,d,S,v){m.diffuse.value.copy(d.color),m.opacity.value=d.opacity,m.size.value=d.size*S,m.scale.value=v*.5,d.map&&(m.map.value=d.map,e(d.map,m.uvTransform)),d.alphaMap&&(m.alphaMap.value=d.alphaMap,e(d.alphaMap,m.alphaMapTransform)),d.alphaTest>0&&(m.alphaTest.value=d.alphaTest)}function c(m,d){m.diffuse.value.copy(d.color),m.opacity.value=d.opacity,m.rotation.value=d.rotation,d.map&&(m.map.value=d.map,e(d.map,m.mapTransform)),d.alphaMap&&(m.alphaMap.value=d.alphaMap,e(d.alphaMap,m.alphaMapTransform)),d.alphaTest>0&&(m.alphaTest.value=d.alphaTest)}function u(m,d){m.specular.value.copy(d.specular),m.shininess.value=Math.max(d.shininess,1e-4)}function f(m,d){d.gradientMap&&(m.gradientMap.value=d.gradientMap)}function h(m,d){m.metalness.value=d.metalness,d.metalnessMap&&(m.metalnessMap.value=d.metalnessMap,e(d.metalnessMap,m.metalnessMapTransform)),m.roughness.value=d.roughness,d.roughnessMap&&(m.roughnessMap.value=d.roughnessMap,e(d.roughnessMap,m.roughnessMapTransform)),d.envMap&&(m.envMapIntensity.value=d.envMapIntensity)}function p(m,d,S){m.ior.value=d.ior,d.sheen>0&&(m.sheenColor.value.copy(d.sheenColor).multiplyScalar(d.sheen),m.sheenRoughness.value=d.sheenRoughness,d.sheenColorMap&&(m.sheenColorMap.value=d.sheenColorMap,e(d.sheenColorMap,m.sheenColorMapTransform)),d.sheenRoughnessMap&&(m.sheenRoughnessMap.value=d.sheenRoughnessMap,e(d.sheenRoughnessMap,m.sheenRoughnessMapTransform))),d.clearcoat>0&&(m.clearcoat.value=d.clearcoat,m.clearcoatRoughness.value=d.clearcoatRoughness,d.clearcoatMap&&(m.clearcoatMap.value=d.clearcoatMap,e(d.clearcoatMap,m.clearcoatMapTransform)),d.clearcoatRoughnessMap&&(m.clearcoatRoughnessMap.value=d.clearcoatRoughnessMap,e(d.clearcoatRoughnessMap,m.clearcoatRoughnessMapTransform)),d.clearcoatNormalMap&&(m.clearcoatNormalMap.value=d.clearcoatNormalMap,e(d.clearcoatNormalMap,m.clearcoatNormalMapTransform),m.clearcoatNormalScale.value.copy(d.clearcoatNormalScale),d.side===Nn&&m.clearcoatNormalScale.value.negate())),d.dispersion>0&&(m.dispersion.value=d.dispersion),d.iridescence>0&&(m.iridescence.value=d.iridescence,m.iridescenceIOR.value=d.iridescenceIOR,m.iridescenceThicknessMinimum.value=d.iridescenceThicknessRange[0],m.iridescenceThicknessMaximum.value=d.iridescenceThicknessRange[1],d.iridescenceMap&&(m.iridescenceMap.value=d.iridescenceMap,e(d.iridescenceMap,m.iridescenceMapTransform)),d.iridescenceThicknessMap&&(m.iridescenceThicknessMap.value=d.iridescenceThicknessMap,e(d.iridescenceThicknessMap,m.iridescenceThicknessMapTransform))),d.transmission>0&&(m.transmission.value=d.transmission,m.transmissionSamplerMap.value=S.texture,m.transmissionSamplerSize.value.set(S.width,S.height),d.transmissionMap&&(m.transmissionMap.value=d.transmissionMap,e(d.transmissionMap,m.transmissionMapTransform)),m.thickness.value=d.thickness,d.thicknessMap&&(m.thicknessMap.value=d.thicknessMap,e(d.thicknessMap,m.thicknessMapTransform)),m.attenuationDistance.value=d.attenuationDistance,m.attenuationColor.value.copy(d.attenuationColor)),d.anisotropy>0&&(m.anisotropyVector.value.set(d.anisotropy*Math.cos(d.anisotropyRotation),d.anisotropy*Math.sin(d.anisotropyRotation)),d.anisotropyMap&&(m.anisotropyMap.value=d.anisotropyMap,e(d.anisotropyMap,m.anisotropyMapTransform))),m.specularIntensity.value=d.specularIntensity,m.specularColor.value.copy(d.specularColor),d.specularColorMap&&(m.specularColorMap.value=d.specularColorMap,e(d.specularColorMap,m.specularColorMapTransform)),d.specularIntensityMap&&(m.specularIntensityMap.value=d.specularIntensityMap,e(d.specularIntensityMap,m.specularIntensityMapTransform))}function _(m,d){d.matcap&&(m.matcap.value=d.matcap)}function g(m,d){let S=t.get(d).light;m.referencePosition.value.setFromMatrixPosition(S.matrixWorld),m.nearDistance.value=S.shadow.camera.near,m.farDistance.value=S.shadow.camera.far}return{refreshFogUniforms:n,refreshMaterialUniforms:s}}function vb(i,t,e,n){let s={},r={},o=[],a=i.getParameter(i.MAX_UNIFORM_BUFFER_BINDINGS);function l(S,v){let y=v.program;n.uniformBlockBinding(S,y)}function c(S,v){let y=s[S.id];y===void 0&&(_(S),y=u(S),s[S.id]=y,S.addEventListener("dispose",m));let I=v.program;n.updateUBOMapping(S,I);let C=t.render.frame;r[S.id]!==C&&(h(S),r[S.id]=C)}function u(S){let v=f();S.__bindingPointIndex=v;let y=i.createBuffer(),I=S.__size,C=S.usage;return i.bindBuffer(i.UNIFORM_BUFFER,y),i.bufferData(i.UNIFORM_BUFFER,I,C),i.bindBuffer(i.UNIFORM_BUFFER,null),i.bindBufferBase(i.UNIFORM_BUFFER,v,y),y}function f(){for(let S=0;S<a;S++)if(o.indexOf(S)===-1)return o.push(S),S;return console.error("THREE.WebGLRenderer: Maximum number of simultaneously usable uniforms groups reached."),0}function h(S){let v=s[S.id],y=S.uniforms,I=S.__cache;i.bindBuffer(i.UNIFORM_BUFFER,v);for(let C=0,R=y.length;C<R;C++){let L=Array.isArray(y[C])?y[C]:[y[C]];for(let E=0,b=L.length;E<b;E++){let A=L[E];if(p(A,C,E,I)===!0){let O=A.__offset,F=Array.isArray(A.value)?A.value:[A.value],G=0;for(let $=0;$<F.length;$++){let W=F[$],Z=g(W);typeof W=="number"||typeof W=="boolean"?(A.__data[0]=W,i.bufferSubData(i.UNIFORM_BUFFER,O+G,A.__data)):W.isMatrix3?(A.__data[0]=W.elements[0],A.__data[1]=W.elements[1],A.__data[2]=W.elements[2],A.__data[3]=0,A.__data[4]=W.elements[3],A.__data[5]=W.elements[4],A.__data[6]=W.elements[5],A.__data[7]=0,A.__data[8]=W.elements[6],A.__data[9]=W.elements[7],A.__data[10]=W.elements[8],A.__data[11]=0):(W.toArray(A.__data,G),G+=Z.storage/Float32Array.BYTES_PER_ELEMENT)}i.bufferSubData(i.UNIFORM_BUFFER,O,A.__data)}}}i.bindBuffer(i.UNIFORM_BUFFER,null)}function p(S,v,y,I){let C=S.value,R=v+"_"+y;if(I[R]===void 0)return typeof C=="number"||typeof C=="boolean"?I[R]=C:I[R]=C.clone(),!0;{let L=I[R];if(typeof C=="number"||typeof C=="boolean"){if(L!==C)return I[R]=C,!0}else if(L.equals(C)===!1)return L.copy(C),!0}return!1}function _(S){let v=S.uniforms,y=0,I=16;for(let R=0,L=v.length;R<L;R++){let E=Array.isArray(v[R])?v[R]:[v[R]];for(let b=0,A=E.length;b<A;b++){let O=E[b],F=Array.isArray(O.value)?O.value:[O.value];for(let G=0,$=F.length;G<$;G++){let W=F[G],Z=g(W),J=y%I,ct=J%Z.boundary,lt=J+ct;y+=ct,lt!==0&&I-lt<Z.storage&&(y+=I-lt),O.__data=new Float32Array(Z.storage/Float32Array.BYTES_PER_ELEMENT),O.__offset=y,y+=Z.storage}}}let C=y%I;return C>0&&(y+=I-C),S.__size=y,S.__cache={},this}function g(S){let v={boundary:0,storage:0};return typeof S=="number"||typeof S=="boolean"?(v.boundary=4,v.storage=4):S.isVector2?(v.boundary=8,v.storage=8):S.isVector3||S.isColor?(v.boundary=16,v.storage=12):S.isVector4?(v.boundary=16,v.storage=16):S.isMatrix3?(v.boundary=48,v.storage=48):S.isMatrix4?(v.boundary=64,v.storage=64):S.isTexture?console.warn("THREE.WebGLRenderer: Texture samplers can not be part of an uniforms group."):console.warn("THREE.WebGLRenderer: Unsupported uniform value type.",S),v}function m(S){let v=S.target;v.removeEventListener("dispose",m);let y=o.indexOf(v.__bindingPointIndex);o.splice(y,1),i.deleteBuffer(s[v.id]),delete s[v.id],delete r[v.id]}function d(){for(let S in s)i.deleteBuffer(s[S]);o=[],s={},r={}}return{bind:l,update:c,dispose:d}}var dl=class{constructor(t={}){let{canvas:e=wx(),context:n=null,depth:s=!0,stencil:r=!1,alpha:o=!1,antialias:a=!1,premultipliedAlpha:l=!0,preserveDrawingBuffer:c=!1,powerPreference:u="default",failIfMajorPerformanceCaveat:f=!1,reverseDepthBuffer:h=!1}=t;this.isWebGLRenderer=!0;let p;if(n!==null){if(typeof WebGLRenderingContext<"u"&&n instanceof WebGLRenderingContext)throw new Error("THREE.WebGLRenderer: WebGL 1 is not supported since r163.");p=n.getContextAttributes().alpha}else p=o;let _=new Uint32Array(4),g=new Int32Array(4),m=null,d=null,S=[],v=[];this.domElement=e,this.debug={checkShaderErrors:!0,onShaderError:null},this.autoClear=!0,this.autoClearColor=!0,this.autoClearDepth=!0,this.autoClearStencil=!0,this.sortObjects=!0,this.clippingPlanes=[],this.localClippingEnabled=!1,this._outputColorSpace=Un,this.toneMapping=vs,this.toneMappingExposure=1;let y=this,I=!1,C=0,R=0,L=null,E=-1,b=null,A=new He,O=new He,F=null,G=new pe(0),$=0,W=e.width,Z=e.height,J=1,ct=null,lt=null,_t=new He(0,0,W,Z),dt=new He(0,0,W,Z),Yt=!1,Q=new Vo,ht=!1,Bt=!1,pt=new Ge,zt=new Ge,j=new Y,st=new He,It={background:null,fog:null,environment:null,overrideMaterial:null,isScene:!0},yt=!1;function Zt(){return L===null?J:1}let N=n;function le(T,k){return e.getContext(T,k)}try{let T={alpha:!0,depth:s,stencil:r,antialias:a,premultipliedAlpha:l,preserveDrawingBuffer:c,powerPreference:u,failIfMajorPerformanceCaveat:f};if("setAttribute"in e&&e.setAttribute("data-engine",`three.js r${wu}`),e.addEventListener("webglcontextlost",at,!1),e.addEventListener("webglcontextrestored",Rt,!1),e.addEventListener("webglcontextcreationerror",Ct,!1),N===null){let k="webgl2";if(N=le(k,T),N===null)throw le(k)?new Error("Error creating WebGL context with your selected attributes."):new Error("Error creating WebGL context.")}}catch(T){throw console.error("THREE.WebGLRenderer: "+T.message),T}let Qt,$t,Dt,me,Tt,P,M,V,rt,et,it,kt,vt,wt,Kt,ut,Mt,Wt,qt,At,re,jt,Me,B;function St(){Qt=new OM(N),Qt.init(),jt=new pb(N,Qt),$t=new PM(N,Qt,t,jt),Dt=new ub(N,Qt),$t.reverseDepthBuffer&&h&&Dt.buffers.depth.setReversed(!0),me=new kM(N),Tt=new jS,P=new db(N,Qt,Dt,Tt,$t,jt,me),M=new LM(y),V=new NM(y),rt=new qx(N),Me=new CM(N,rt),et=new FM(N,rt,me,Me),it=new VM(N,et,rt,me),qt=new zM(N,$t,P),ut=new IM(Tt),kt=new KS(y,M,V,Qt,$t,Me,ut),vt=new yb(y,Tt),wt=new tb,Kt=new ob(Qt),Wt=new AM(y,M,V,Dt,it,p,l),Mt=new cb(y,it,$t),B=new vb(N,me,$t,Dt),At=new RM(N,Qt,me),re=new BM(N,Qt,me),me.programs=kt.programs,y.capabilities=$t,y.extensions=Qt,y.properties=Tt,y.renderLists=wt,y.shadowMap=Mt,y.state=Dt,y.info=me}St();let nt=new uu(y,N);this.xr=nt,this.getContext=function(){return N},this.getContextAttributes=function(){return N.getContextAttributes()},this.forceContextLoss=function(){let T=Qt.get("WEBGL_lose_context");T&&T.loseContext()},this.forceContextRestore=function(){let T=Qt.get("WEBGL_lose_context");T&&T.restoreContext()},this.getPixelRatio=function(){return J},this.setPixelRatio=function(T){T!==void 0&&(J=T,this.setSize(W,Z,!1))},this.getSize=function(T){return T.set(W,Z)},this.setSize=function(T,k,X=!0){if(nt.isPresenting){console.warn("THREE.WebGLRenderer: Can't change size while VR device is presenting.");return}W=T,Z=k,e.width=Math.floor(T*J),e.height=Math.floor(k*J),X===!0&&(e.style.width=T+"px",e.style.height=k+"px"),this.setViewport(0,0,T,k)},this.getDrawingBufferSize=function(T){return T.set(W*J,Z*J).floor()},this.setDrawingBufferSize=function(T,k,X){W=T,Z=k,J=X,e.width=Math.floor(T*X),e.height=Math.floor(k*X),this.setViewport(0,0,T,k)},this.getCurrentViewport=function(T){return T.copy(A)},this.getViewport=function(T){return T.copy(_t)},this.setViewport=function(T,k,X,tt){T.isVector4?_t.set(T.x,T.y,T.z,T.w):_t.set(T,k,X,tt),Dt.viewport(A.copy(_t).multiplyScalar(J).round())},this.getScissor=function(T){return T.copy(dt)},this.setScissor=function(T,k,X,tt){T.isVector4?dt.set(T.x,T.y,T.z,T.w):dt.set(T,k,X,tt),Dt.scissor(O.copy(dt).multiplyScalar(J).round())},this.getScissorTest=function(){return Yt},this.setScissorTest=function(T){Dt.setScissorTest(Yt=T)},this.setOpaqueSort=function(T){ct=T},this.setTransparentSort=function(T){lt=T},this.getClearColor=function(T){return T.copy(Wt.getClearColor())},this.setClearColor=function(){Wt.setClearColor.apply(Wt,arguments)},this.getClearAlpha=function(){return Wt.getClearAlpha()},this.setClearAlpha=function(){Wt.setClearAlpha.apply(Wt,arguments)},this.clear=function(T=!0,k=!0,X=!0){let tt=0;if(T){let H=!1;if(L!==null){let mt=L.texture.format;H=mt===Pu||mt===Ru||mt===Cu}if(H){let mt=L.texture.type,Et=mt===ji||mt===Ks||mt===Bo||mt===Kr||mt===Tu||mt===Au,Ht=Wt.getClearColor(),Vt=Wt.getClearAlpha(),Jt=Ht.r,te=Ht.g,Gt=Ht.b;Et?(_[0]=Jt,_[1]=te,_[2]=Gt,_[3]=Vt,N.clearBufferuiv(N.COLOR,0,_)):(g[0]=Jt,g[1]=te,g[2]=Gt,g[3]=Vt,N.clearBufferiv(N.COLOR,0,g))}else tt|=N.COLOR_BUFFER_BIT}k&&(tt|=N.DEPTH_BUFFER_BIT),X&&(tt|=N.STENCIL_BUFFER_BIT,this.state.buffers.stencil.setMask(4294967295)),N.clear(tt)},this.clearColor=function(){this.clear(!0,!1,!1)},this.clearDepth=function(){this.clear(!1,!0,!1)},this.clearStencil=function(){this.clear(!1,!1,!0)},this.dispose=function(){e.removeEventListener("webglcontextlost",at,!1),e.removeEventListener("webglcontextrestored",Rt,!1),e.removeEventListener("webglcontextcreationerror",Ct,!1),wt.dispose(),Kt.dispose(),Tt.dispose(),M.dispose(),V.dispose(),it.dispose(),Me.dispose(),B.dispose(),kt.dispose(),nt.dispose(),nt.removeEventListener("sessionstart",Ni),nt.removeEventListener("sessionend",Oi),Xe.stop()};function at(T){T.preventDefault(),console.log("THREE.WebGLRenderer: Context Lost."),I=!0}function Rt(){console.log("THREE.WebGLRenderer: Context Restored."),I=!1;let T=me.autoReset,k=Mt.enabled,X=Mt.autoUpdate,tt=Mt.needsUpdate,H=Mt.type;St(),me.autoReset=T,Mt.enabled=k,Mt.autoUpdate=X,Mt.needsUpdate=tt,Mt.type=H}function Ct(T){console.error("THREE.WebGLRenderer: A WebGL context could not be created. Reason: ",T.statusMessage)}function ne(T){let k=T.target;k.removeEventListener("dispose",ne),Fe(k)}function Fe(T){Ut(T),Tt.remove(T)}function Ut(T){let k=Tt.get(T).programs;k!==void 0&&(k.forEach(function(X){kt.releaseProgram(X)}),T.isShaderMaterial&&kt.releaseShaderCache(T))}this.renderBufferDirect=function(T,k,X,tt,H,mt){k===null&&(k=It);let Et=H.isMesh&&H.matrixWorld.determinant()<0,Ht=ws(T,k,X,tt,H);Dt.setMaterial(tt,Et);let Vt=X.index,Jt=1;if(tt.wireframe===!0){if(Vt=et.getWireframeAttribute(X),Vt===void 0)return;Jt=2}let te=X.drawRange,Gt=X.attributes.position,ue=te.start*Jt,be=(te.start+te.count)*Jt;mt!==null&&(ue=Math.max(ue,mt.start*Jt),be=Math.min(be,(mt.start+mt.count)*Jt)),Vt!==null?(ue=Math.max(ue,0),be=Math.min(be,Vt.count)):Gt!=null&&(ue=Math.max(ue,0),be=Math.min(be,Gt.count));let Ee=be-ue;if(Ee<0||Ee===1/0)return;Me.setup(H,tt,Ht,X,Vt);let on,_e=At;if(Vt!==null&&(on=rt.get(Vt),_e=re,_e.setIndex(on)),H.isMesh)tt.wireframe===!0?(Dt.setLineWidth(tt.wireframeLinewidth*Zt()),_e.setMode(N.LINES)):_e.setMode(N.TRIANGLES);else if(H.isLine){let Nt=tt.linewidth;Nt===void 0&&(Nt=1),Dt.setLineWidth(Nt*Zt()),H.isLineSegments?_e.setMode(N.LINES):H.isLineLoop?_e.setMode(N.LINE_LOOP):_e.setMode(N.LINE_STRIP)}else H.isPoints?_e.setMode(N.POINTS):H.isSprite&&_e.setMode(N.TRIANGLES);if(H.isBatchedMesh)if(H._multiDrawInstances!==null)_e.renderMultiDrawInstances(H._multiDrawStarts,H._multiDrawCounts,H._multiDrawCount,H._multiDrawInstances);else if(Qt.get("WEBGL_multi_draw"))_e.renderMultiDraw(H._multiDrawStarts,H._multiDrawCounts,H._multiDrawCount);else{let Nt=H._multiDrawStarts,Zn=H._multiDrawCounts,xe=H._multiDrawCount,yn=Vt?rt.get(Vt).bytesPerElement:1,Bi=Tt.get(tt).currentProgram.getUniforms();for(let vn=0;vn<xe;vn++)Bi.setValue(N,"_gl_DrawID",vn),_e.render(Nt[vn]/yn,Zn[vn])}else if(H.isInstancedMesh)_e.renderInstances(ue,Ee,H.count);else if(X.isInstancedBufferGeometry){let Nt=X._maxInstanceCount!==void 0?X._maxInstanceCount:1/0,Zn=Math.min(X.instanceCount,Nt);_e.renderInstances(ue,Ee,Zn)}else _e.render(ue,Ee)};function ce(T,k,X){T.transparent===!0&&T.side===ii&&T.forceSinglePass===!1?(T.side=Nn,T.needsUpdate=!0,ir(T,k,X),T.side=Ms,T.needsUpdate=!0,ir(T,k,X),T.side=ii):ir(T,k,X)}this.compile=function(T,k,X=null){X===null&&(X=T),d=Kt.get(X),d.init(k),v.push(d),X.traverseVisible(function(H){H.isLight&&H.layers.test(k.layers)&&(d.pushLight(H),H.castShadow&&d.pushShadow(H))}),T!==X&&T.traverseVisible(function(H){H.isLight&&H.layers.test(k.layers)&&(d.pushLight(H),H.castShadow&&d.pushShadow(H))}),d.setupLights();let tt=new Set;return T.traverse(function(H){if(!(H.isMesh||H.isPoints||H.isLine||H.isSprite))return;let mt=H.material;if(mt)if(Array.isArray(mt))for(let Et=0;Et<mt.length;Et++){let Ht=mt[Et];ce(Ht,X,H),tt.add(Ht)}else ce(mt,X,H),tt.add(mt)}),v.pop(),d=null,tt},this.compileAsync=function(T,k,X=null){let tt=this.compile(T,k,X);return new Promise(H=>{function mt(){if(tt.forEach(function(Et){Tt.get(Et).currentProgram.isReady()&&tt.delete(Et)}),tt.size===0){H(T);return}setTimeout(mt,10)}Qt.get("KHR_parallel_shader_compile")!==null?mt():setTimeout(mt,10)})};let Te=null;function rn(T){Te&&Te(T)}function Ni(){Xe.stop()}function Oi(){Xe.start()}let Xe=new Lm;Xe.setAnimationLoop(rn),typeof self<"u"&&Xe.setContext(self),this.setAnimationLoop=function(T){Te=T,nt.setAnimationLoop(T),T===null?Xe.stop():Xe.start()},nt.addEventListener("sessionstart",Ni),nt.addEventListener("sessionend",Oi),this.render=function(T,k){if(k!==void 0&&k.isCamera!==!0){console.error("THREE.WebGLRenderer.render: camera is not an instance of THREE.Camera.");return}if(I===!0)return;if(T.matrixWorldAutoUpdate===!0&&T.updateMatrixWorld(),k.parent===null&&k.matrixWorldAutoUpdate===!0&&k.updateMatrixWorld(),nt.enabled===!0&&nt.isPresenting===!0&&(nt.cameraAutoUpdate===!0&&nt.updateCamera(k),k=nt.getCamera()),T.isScene===!0&&T.onBeforeRender(y,T,k,L),d=Kt.get(T,v.length),d.init(k),v.push(d),zt.multiplyMatrices(k.projectionMatrix,k.matrixWorldInverse),Q.setFromProjectionMatrix(zt),Bt=this.localClippingEnabled,ht=ut.init(this.clippingPlanes,Bt),m=wt.get(T,S.length),m.init(),S.push(m),nt.enabled===!0&&nt.isPresenting===!0){let mt=y.xr.getDepthSensingMesh();mt!==null&&Mi(mt,k,-1/0,y.sortObjects)}Mi(T,k,0,y.sortObjects),m.finish(),y.sortObjects===!0&&m.sort(ct,lt),yt=nt.enabled===!1||nt.isPresenting===!1||nt.hasDepthSensing()===!1,yt&&Wt.addToRenderList(m,T),this.info.render.frame++,ht===!0&&ut.beginShadows();let X=d.state.shadowsArray;Mt.render(X,T,k),ht===!0&&ut.endShadows(),this.info.autoReset===!0&&this.info.reset();let tt=m.opaque,H=m.transmissive;if(d.setupLights(),k.isArrayCamera){let mt=k.cameras;if(H.length>0)for(let Et=0,Ht=mt.length;Et<Ht;Et++){let Vt=mt[Et];lo(tt,H,T,Vt)}yt&&Wt.render(T);for(let Et=0,Ht=mt.length;Et<Ht;Et++){let Vt=mt[Et];Fi(m,T,Vt,Vt.viewport)}}else H.length>0&&lo(tt,H,T,k),yt&&Wt.render(T),Fi(m,T,k);L!==null&&(P.updateMultisampleRenderTarget(L),P.updateRenderTargetMipmap(L)),T.isScene===!0&&T.onAfterRender(y,T,k),Me.resetDefaultState(),E=-1,b=null,v.pop(),v.length>0?(d=v[v.length-1],ht===!0&&ut.setGlobalState(y.clippingPlanes,d.state.camera)):d=null,S.pop(),S.length>0?m=S[S.length-1]:m=null};function Mi(T,k,X,tt){if(T.visible===!1)return;if(T.layers.test(k.layers)){if(T.isGroup)X=T.renderOrder;else if(T.isLOD)T.autoUpdate===!0&&T.update(k);else if(T.isLight)d.pushLight(T),T.castShadow&&d.pushShadow(T);else if(T.isSprite){if(!T.frustumCulled||Q.intersectsSprite(T)){tt&&st.setFromMatrixPosition(T.matrixWorld).applyMatrix4(zt);let Et=it.update(T),Ht=T.material;Ht.visible&&m.push(T,Et,Ht,X,st.z,null)}}else if((T.isMesh||T.isLine||T.isPoints)&&(!T.frustumCulled||Q.intersectsObject(T))){let Et=it.update(T),Ht=T.material;if(tt&&(T.boundingSphere!==void 0?(T.boundingSphere===null&&T.computeBoundingSphere(),st.copy(T.boundingSphere.center)):(Et.boundingSphere===null&&Et.computeBoundingSphere(),st.copy(Et.boundingSphere.center)),st.applyMatrix4(T.matrixWorld).applyMatrix4(zt)),Array.isArray(Ht)){let Vt=Et.groups;for(let Jt=0,te=Vt.length;Jt<te;Jt++){let Gt=Vt[Jt],ue=Ht[Gt.materialIndex];ue&&ue.visible&&m.push(T,Et,ue,X,st.z,Gt)}}else Ht.visible&&m.push(T,Et,Ht,X,st.z,null)}}let mt=T.children;for(let Et=0,Ht=mt.length;Et<Ht;Et++)Mi(mt[Et],k,X,tt)}function Fi(T,k,X,tt){let H=T.opaque,mt=T.transmissive,Et=T.transparent;d.setupLightsView(X),ht===!0&&ut.setGlobalState(y.clippingPlanes,X),tt&&Dt.viewport(A.copy(tt)),H.length>0&&bs(H,k,X),mt.length>0&&bs(mt,k,X),Et.length>0&&bs(Et,k,X),Dt.buffers.depth.setTest(!0),Dt.buffers.depth.setMask(!0),Dt.buffers.color.setMask(!0),Dt.setPolygonOffset(!1)}function lo(T,k,X,tt){if((X.isScene===!0?X.overrideMaterial:null)!==null)return;d.state.transmissionRenderTarget[tt.id]===void 0&&(d.state.transmissionRenderTarget[tt.id]=new ts(1,1,{generateMipmaps:!0,type:Qt.has("EXT_color_buffer_half_float")||Qt.has("EXT_color_buffer_float")?Xo:ji,minFilter:Js,samples:4,stencilBuffer:r,resolveDepthBuffer:!1,resolveStencilBuffer:!1,colorSpace:ye.workingColorSpace}));let mt=d.state.transmissionRenderTarget[tt.id],Et=tt.viewport||A;mt.setSize(Et.z,Et.w);let Ht=y.getRenderTarget();y.setRenderTarget(mt),y.getClearColor(G),$=y.getClearAlpha(),$<1&&y.setClearColor(16777215,.5),y.clear(),yt&&Wt.render(X);let Vt=y.toneMapping;y.toneMapping=vs;let Jt=tt.viewport;if(tt.viewport!==void 0&&(tt.viewport=void 0),d.setupLightsView(tt),ht===!0&&ut.setGlobalState(y.clippingPlanes,tt),bs(T,X,tt),P.updateMultisampleRenderTarget(mt),P.updateRenderTargetMipmap(mt),Qt.has("WEBGL_multisampled_render_to_texture")===!1){let te=!1;for(let Gt=0,ue=k.length;Gt<ue;Gt++){let be=k[Gt],Ee=be.object,on=be.geometry,_e=be.material,Nt=be.group;if(_e.side===ii&&Ee.layers.test(tt.layers)){let Zn=_e.side;_e.side=Nn,_e.needsUpdate=!0,Yo(Ee,X,tt,on,_e,Nt),_e.side=Zn,_e.needsUpdate=!0,te=!0}}te===!0&&(P.updateMultisampleRenderTarget(mt),P.updateRenderTargetMipmap(mt))}y.setRenderTarget(Ht),y.setClearColor(G,$),Jt!==void 0&&(tt.viewport=Jt),y.toneMapping=Vt}function bs(T,k,X){let tt=k.isScene===!0?k.overrideMaterial:null;for(let H=0,mt=T.length;H<mt;H++){let Et=T[H],Ht=Et.object,Vt=Et.geometry,Jt=tt===null?Et.material:tt,te=Et.group;Ht.layers.test(X.layers)&&Yo(Ht,k,X,Vt,Jt,te)}}function Yo(T,k,X,tt,H,mt){T.onBeforeRender(y,k,X,tt,H,mt),T.modelViewMatrix.multiplyMatrices(X.matrixWorldInverse,T.matrixWorld),T.normalMatrix.getNormalMatrix(T.modelViewMatrix),H.onBeforeRender(y,k,X,tt,T,mt),H.transparent===!0&&H.side===ii&&H.forceSinglePass===!1?(H.side=Nn,H.needsUpdate=!0,y.renderBufferDirect(X,k,tt,H,T,mt),H.side=Ms,H.needsUpdate=!0,y.renderBufferDirect(X,k,tt,H,T,mt),H.side=ii):y.renderBufferDirect(X,k,tt,H,T,mt),T.onAfterRender(y,k,X,tt,H,mt)}function ir(T,k,X){k.isScene!==!0&&(k=It);let tt=Tt.get(T),H=d.state.lights,mt=d.state.shadowsArray,Et=H.state.version,Ht=kt.getParameters(T,H.state,mt,k,X),Vt=kt.getProgramCacheKey(Ht),Jt=tt.programs;tt.environment=T.isMeshStandardMaterial?k.environment:null,tt.fog=k.fog,tt.envMap=(T.isMeshStandardMaterial?V:M).get(T.envMap||tt.environment),tt.envMapRotation=tt.environment!==null&&T.envMap===null?k.environmentRotation:T.envMapRotation,Jt===void 0&&(T.addEventListener("dispose",ne),Jt=new Map,tt.programs=Jt);let te=Jt.get(Vt);if(te!==void 0){if(tt.currentProgram===te&&tt.lightsStateVersion===Et)return $o(T,Ht),te}else Ht.uniforms=kt.getUniforms(T),T.onBeforeCompile(Ht,y),te=kt.acquireProgram(Ht,Vt),Jt.set(Vt,te),tt.uniforms=Ht.uniforms;let Gt=tt.uniforms;return(!T.isShaderMaterial&&!T.isRawShaderMaterial||T.clipping===!0)&&(Gt.clippingPlanes=ut.uniform),$o(T,Ht),tt.needsLights=bi(T),tt.lightsStateVersion=Et,tt.needsLights&&(Gt.ambientLightColor.value=H.state.ambient,Gt.lightProbe.value=H.state.probe,Gt.directionalLights.value=H.state.directional,Gt.directionalLightShadows.value=H.state.directionalShadow,Gt.spotLights.value=H.state.spot,Gt.spotLightShadows.value=H.state.spotShadow,Gt.rectAreaLights.value=H.state.rectArea,Gt.ltc_1.value=H.state.rectAreaLTC1,Gt.ltc_2.value=H.state.rectAreaLTC2,Gt.pointLights.value=H.state.point,Gt.pointLightShadows.value=H.state.pointShadow,Gt.hemisphereLights.value=H.state.hemi,Gt.directionalShadowMap.value=H.state.directionalShadowMap,Gt.directionalShadowMatrix.value=H.state.directionalShadowMatrix,Gt.spotShadowMap.value=H.state.spotShadowMap,Gt.spotLightMatrix.value=H.state.spotLightMatrix,Gt.spotLightMap.value=H.state.spotLightMap,Gt.pointShadowMap.value=H.state.pointShadowMap,Gt.pointShadowMatrix.value=H.state.pointShadowMatrix),tt.currentProgram=te,tt.uniformsList=null,te}function Si(T){if(T.uniformsList===null){let k=T.currentProgram.getUniforms();T.uniformsList=Yr.seqWithValue(k.seq,T.uniforms)}return T.uniformsList}function $o(T,k){let X=Tt.get(T);X.outputColorSpace=k.outputColorSpace,X.batching=k.batching,X.batchingColor=k.batchingColor,X.instancing=k.instancing,X.instancingColor=k.instancingColor,X.instancingMorph=k.instancingMorph,X.skinning=k.skinning,X.morphTargets=k.morphTargets,X.morphNormals=k.morphNormals,X.morphColors=k.morphColors,X.morphTargetsCount=k.morphTargetsCount,X.numClippingPlanes=k.numClippingPlanes,X.numIntersection=k.numClipIntersection,X.vertexAlphas=k.vertexAlphas,X.vertexTangents=k.vertexTangents,X.toneMapping=k.toneMapping}function ws(T,k,X,tt,H){k.isScene!==!0&&(k=It),P.resetTextureUnits();let mt=k.fog,Et=tt.isMeshStandardMaterial?k.environment:null,Ht=L===null?y.outputColorSpace:L.isXRRenderTarget===!0?L.texture.colorSpace:ro,Vt=(tt.isMeshStandardMaterial?V:M).get(tt.envMap||Et),Jt=tt.vertexColors===!0&&!!X.attributes.color&&X.attributes.color.itemSize===4,te=!!X.attributes.tangent&&(!!tt.normalMap||tt.anisotropy>0),Gt=!!X.morphAttributes.position,ue=!!X.morphAttributes.normal,be=!!X.morphAttributes.color,Ee=vs;tt.toneMapped&&(L===null||L.isXRRenderTarget===!0)&&(Ee=y.toneMapping);let on=X.morphAttributes.position||X.morphAttributes.normal||X.morphAttributes.color,_e=on!==void 0?on.length:0,Nt=Tt.get(tt),Zn=d.state.lights;if(ht===!0&&(Bt===!0||T!==b)){let Pn=T===b&&tt.id===E;ut.setState(tt,T,Pn)}let xe=!1;tt.version===Nt.__version?(Nt.needsLights&&Nt.lightsStateVersion!==Zn.state.version||Nt.outputColorSpace!==Ht||H.isBatchedMesh&&Nt.batching===!1||!H.isBatchedMesh&&Nt.batching===!0||H.isBatchedMesh&&Nt.batchingColor===!0&&H.colorTexture===null||H.isBatchedMesh&&Nt.batchingColor===!1&&H.colorTexture!==null||H.isInstancedMesh&&Nt.instancing===!1||!H.isInstancedMesh&&Nt.instancing===!0||H.isSkinnedMesh&&Nt.skinning===!1||!H.isSkinnedMesh&&Nt.skinning===!0||H.isInstancedMesh&&Nt.instancingColor===!0&&H.instanceColor===null||H.isInstancedMesh&&Nt.instancingColor===!1&&H.instanceColor!==null||H.isInstancedMesh&&Nt.instancingMorph===!0&&H.morphTexture===null||H.isInstancedMesh&&Nt.instancingMorph===!1&&H.morphTexture!==null||Nt.envMap!==Vt||tt.fog===!0&&Nt.fog!==mt||Nt.numClippingPlanes!==void 0&&(Nt.numClippingPlanes!==ut.numPlanes||Nt.numIntersection!==ut.numIntersection)||Nt.vertexAlphas!==Jt||Nt.vertexTangents!==te||Nt.morphTargets!==Gt||Nt.morphNormals!==ue||Nt.morphColors!==be||Nt.toneMapping!==Ee||Nt.morphTargetsCount!==_e)&&(xe=!0):(xe=!0,Nt.__version=tt.version);let yn=Nt.currentProgram;xe===!0&&(yn=ir(tt,k,H));let Bi=!1,vn=!1,Es=!1,Pe=yn.getUniforms(),zn=Nt.uniforms;if(Dt.useProgram(yn.program)&&(Bi=!0,vn=!0,Es=!0),tt.id!==E&&(E=tt.id,vn=!0),Bi||b!==T){Dt.buffers.depth.getReversed()?(pt.copy(T.projectionMatrix),Tx(pt),Ax(pt),Pe.setValue(N,"projectionMatrix",pt)):Pe.setValue(N,"projectionMatrix",T.projectionMatrix),Pe.setValue(N,"viewMatrix",T.matrixWorldInverse);let si=Pe.map.cameraPosition;si!==void 0&&si.setValue(N,j.setFromMatrixPosition(T.matrixWorld)),$t.logarithmicDepthBuffer&&Pe.setValue(N,"logDepthBufFC",2/(Math.log(T.far+1)/Math.LN2)),(tt.isMeshPhongMaterial||tt.isMeshToonMaterial||tt.isMeshLambertMaterial||tt.isMeshBasicMaterial||tt.isMeshStandardMaterial||tt.isShaderMaterial)&&Pe.setValue(N,"isOrthographic",T.isOrthographicCamera===!0),b!==T&&(b=T,vn=!0,Es=!0)}if(H.isSkinnedMesh){Pe.setOptional(N,H,"bindMatrix"),Pe.setOptional(N,H,"bindMatrixInverse");let Pn=H.skeleton;Pn&&(Pn.boneTexture===null&&Pn.computeBoneTexture(),Pe.setValue(N,"boneTexture",Pn.boneTexture,P))}H.isBatchedMesh&&(Pe.setOptional(N,H,"batchingTexture"),Pe.setValue(N,"batchingTexture",H._matricesTexture,P),Pe.setOptional(N,H,"batchingIdTexture"),Pe.setValue(N,"batchingIdTexture",H._indirectTexture,P),Pe.setOptional(N,H,"batchingColorTexture"),H._colorsTexture!==null&&Pe.setValue(N,"batchingColorTexture",H._colorsTexture,P));let es=X.morphAttributes;if((es.position!==void 0||es.normal!==void 0||es.color!==void 0)&&qt.update(H,X,yn),(vn||Nt.receiveShadow!==H.receiveShadow)&&(Nt.receiveShadow=H.receiveShadow,Pe.setValue(N,"receiveShadow",H.receiveShadow)),tt.isMeshGouraudMaterial&&tt.envMap!==null&&(zn.envMap.value=Vt,zn.flipEnvMap.value=Vt.isCubeTexture&&Vt.isRenderTargetTexture===!1?-1:1),tt.isMeshStandardMaterial&&tt.envMap===null&&k.environment!==null&&(zn.envMapIntensity.value=k.environmentIntensity),vn&&(Pe.setValue(N,"toneMappingExposure",y.toneMappingExposure),Nt.needsLights&&Zo(zn,Es),mt&&tt.fog===!0&&vt.refreshFogUniforms(zn,mt),vt.refreshMaterialUniforms(zn,tt,J,Z,d.state.transmissionRenderTarget[T.id]),Yr.upload(N,Si(Nt),zn,P)),tt.isShaderMaterial&&tt.uniformsNeedUpdate===!0&&(Yr.upload(N,Si(Nt),zn,P),tt.uniformsNeedUpdate=!1),tt.isSpriteMaterial&&Pe.setValue(N,"center",H.center),Pe.setValue(N,"modelViewMatrix",H.modelViewMatrix),Pe.setValue(N,"normalMatrix",H.normalMatrix),Pe.setValue(N,"modelMatrix",H.matrixWorld),tt.isShaderMaterial||tt.isRawShaderMaterial){let Pn=tt.uniformsGroups;for(let si=0,Jn=Pn.length;si<Jn;si++){let Ts=Pn[si];B.update(Ts,yn),B.bind(Ts,yn)}}return yn}function Zo(T,k){T.ambientLightColor.needsUpdate=k,T.lightProbe.needsUpdate=k,T.directionalLights.needsUpdate=k,T.directionalLightShadows.needsUpdate=k,T.pointLights.needsUpdate=k,T.pointLightShadows.needsUpdate=k,T.spotLights.needsUpdate=k,T.spotLightShadows.needsUpdate=k,T.rectAreaLights.needsUpdate=k,T.hemisphereLights.needsUpdate=k}function bi(T){return T.isMeshLambertMaterial||T.isMeshToonMaterial||T.isMeshPhongMaterial||T.isMeshStandardMaterial||T.isShadowMaterial||T.isShaderMaterial&&T.lights===!0}this.getActiveCubeFace=function(){return C},this.getActiveMipmapLevel=function(){return R},this.getRenderTarget=function(){return L},this.setRenderTargetTextures=function(T,k,X){Tt.get(T.texture).__webglTexture=k,Tt.get(T.depthTexture).__webglTexture=X;let tt=Tt.get(T);tt.__hasExternalTextures=!0,tt.__autoAllocateDepthBuffer=X===void 0,tt.__autoAllocateDepthBuffer||Qt.has("WEBGL_multisampled_render_to_texture")===!0&&(console.warn("THREE.WebGLRenderer: Render-to-texture extension was disabled because an external texture was provided"),tt.__useRenderToTexture=!1)},this.setRenderTargetFramebuffer=function(T,k){let X=Tt.get(T);X.__webglFramebuffer=k,X.__useDefaultFramebuffer=k===void 0},this.setRenderTarget=function(T,k=0,X=0){L=T,C=k,R=X;let tt=!0,H=null,mt=!1,Et=!1;if(T){let Vt=Tt.get(T);if(Vt.__useDefaultFramebuffer!==void 0)Dt.bindFramebuffer(N.FRAMEBUFFER,null),tt=!1;else if(Vt.__webglFramebuffer===void 0)P.setupRenderTarget(T);else if(Vt.__hasExternalTextures)P.rebindTextures(T,Tt.get(T.texture).__webglTexture,Tt.get(T.depthTexture).__webglTexture);else if(T.depthBuffer){let Gt=T.depthTexture;if(Vt.__boundDepthTexture!==Gt){if(Gt!==null&&Tt.has(Gt)&&(T.width!==Gt.image.width||T.height!==Gt.image.height))throw new Error("WebGLRenderTarget: Attached DepthTexture is initialized to the incorrect size.");P.setupDepthRenderbuffer(T)}}let Jt=T.texture;(Jt.isData3DTexture||Jt.isDataArrayTexture||Jt.isCompressedArrayTexture)&&(Et=!0);let te=Tt.get(T).__webglFramebuffer;T.isWebGLCubeRenderTarget?(Array.isArray(te[k])?H=te[k][X]:H=te[k],mt=!0):T.samples>0&&P.useMultisampledRTT(T)===!1?H=Tt.get(T).__webglMultisampledFramebuffer:Array.isArray(te)?H=te[X]:H=te,A.copy(T.viewport),O.copy(T.scissor),F=T.scissorTest}else A.copy(_t).multiplyScalar(J).floor(),O.copy(dt).multiplyScalar(J).floor(),F=Yt;if(Dt.bindFramebuffer(N.FRAMEBUFFER,H)&&tt&&Dt.drawBuffers(T,H),Dt.viewport(A),Dt.scissor(O),Dt.setScissorTest(F),mt){let Vt=Tt.get(T.texture);N.framebufferTexture2D(N.FRAMEBUFFER,N.COLOR_ATTACHMENT0,N.TEXTURE_CUBE_MAP_POSITIVE_X+k,Vt.__webglTexture,X)}else if(Et){let Vt=Tt.get(T.texture),Jt=k||0;N.framebufferTextureLayer(N.FRAMEBUFFER,N.COLOR_ATTACHMENT0,Vt.__webglTexture,X||0,Jt)}E=-1},this.readRenderTargetPixels=function(T,k,X,tt,H,mt,Et){if(!(T&&T.isWebGLRenderTarget)){console.error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");return}let Ht=Tt.get(T).__webglFramebuffer;if(T.isWebGLCubeRenderTarget&&Et!==void 0&&(Ht=Ht[Et]),Ht){Dt.bindFramebuffer(N.FRAMEBUFFER,Ht);try{let Vt=T.texture,Jt=Vt.format,te=Vt.type;if(!$t.textureFormatReadable(Jt)){console.error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not in RGBA or implementation defined format.");return}if(!$t.textureTypeReadable(te)){console.error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not in UnsignedByteType or implementation defined type.");return}k>=0&&k<=T.width-tt&&X>=0&&X<=T.height-H&&N.readPixels(k,X,tt,H,jt.convert(Jt),jt.convert(te),mt)}finally{let Vt=L!==null?Tt.get(L).__webglFramebuffer:null;Dt.bindFramebuffer(N.FRAMEBUFFER,Vt)}}},this.readRenderTargetPixelsAsync=async function(T,k,X,tt,H,mt,Et){if(!(T&&T.isWebGLRenderTarget))throw new Error("THREE.WebGLRenderer.readRenderTargetPixels: renderTarget is not THREE.WebGLRenderTarget.");let Ht=Tt.get(T).__webglFramebuffer;if(T.isWebGLCubeRenderTarget&&Et!==void 0&&(Ht=Ht[Et]),Ht){let Vt=T.texture,Jt=Vt.format,te=Vt.type;if(!$t.textureFormatReadable(Jt))throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in RGBA or implementation defined format.");if(!$t.textureTypeReadable(te))throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: renderTarget is not in UnsignedByteType or implementation defined type.");if(k>=0&&k<=T.width-tt&&X>=0&&X<=T.height-H){Dt.bindFramebuffer(N.FRAMEBUFFER,Ht);let Gt=N.createBuffer();N.bindBuffer(N.PIXEL_PACK_BUFFER,Gt),N.bufferData(N.PIXEL_PACK_BUFFER,mt.byteLength,N.STREAM_READ),N.readPixels(k,X,tt,H,jt.convert(Jt),jt.convert(te),0);let ue=L!==null?Tt.get(L).__webglFramebuffer:null;Dt.bindFramebuffer(N.FRAMEBUFFER,ue);let be=N.fenceSync(N.SYNC_GPU_COMMANDS_COMPLETE,0);return N.flush(),await Ex(N,be,4),N.bindBuffer(N.PIXEL_PACK_BUFFER,Gt),N.getBufferSubData(N.PIXEL_PACK_BUFFER,0,mt),N.deleteBuffer(Gt),N.deleteSync(be),mt}else throw new Error("THREE.WebGLRenderer.readRenderTargetPixelsAsync: requested read bounds are out of range.")}},this.copyFramebufferToTexture=function(T,k=null,X=0){T.isTexture!==!0&&(Do("WebGLRenderer: copyFramebufferToTexture function signature has changed."),k=arguments[0]||null,T=arguments[1]);let tt=Math.pow(2,-X),H=Math.floor(T.image.width*tt),mt=Math.floor(T.image.height*tt),Et=k!==null?k.x:0,Ht=k!==null?k.y:0;P.setTexture2D(T,0),N.copyTexSubImage2D(N.TEXTURE_2D,X,0,0,Et,Ht,H,mt),Dt.unbindTexture()},this.copyTextureToTexture=function(T,k,X=null,tt=null,H=0){T.isTexture!==!0&&(Do("WebGLRenderer: copyTextureToTexture function signature has changed."),tt=arguments[0]||null,T=arguments[1],k=arguments[2],H=arguments[3]||0,X=null);let mt,Et,Ht,Vt,Jt,te,Gt,ue,be,Ee=T.isCompressedTexture?T.mipmaps[H]:T.image;X!==null?(mt=X.max.x-X.min.x,Et=X.max.y-X.min.y,Ht=X.isBox3?X.max.z-X.min.z:1,Vt=X.min.x,Jt=X.min.y,te=X.isBox3?X.min.z:0):(mt=Ee.width,Et=Ee.height,Ht=Ee.depth||1,Vt=0,Jt=0,te=0),tt!==null?(Gt=tt.x,ue=tt.y,be=tt.z):(Gt=0,ue=0,be=0);let on=jt.convert(k.format),_e=jt.convert(k.type),Nt;k.isData3DTexture?(P.setTexture3D(k,0),Nt=N.TEXTURE_3D):k.isDataArrayTexture||k.isCompressedArrayTexture?(P.setTexture2DArray(k,0),Nt=N.TEXTURE_2D_ARRAY):(P.setTexture2D(k,0),Nt=N.TEXTURE_2D),N.pixelStorei(N.UNPACK_FLIP_Y_WEBGL,k.flipY),N.pixelStorei(N.UNPACK_PREMULTIPLY_ALPHA_WEBGL,k.premultiplyAlpha),N.pixelStorei(N.UNPACK_ALIGNMENT,k.unpackAlignment);let Zn=N.getParameter(N.UNPACK_ROW_LENGTH),xe=N.getParameter(N.UNPACK_IMAGE_HEIGHT),yn=N.getParameter(N.UNPACK_SKIP_PIXELS),Bi=N.getParameter(N.UNPACK_SKIP_ROWS),vn=N.getParameter(N.UNPACK_SKIP_IMAGES);N.pixelStorei(N.UNPACK_ROW_LENGTH,Ee.width),N.pixelStorei(N.UNPACK_IMAGE_HEIGHT,Ee.height),N.pixelStorei(N.UNPACK_SKIP_PIXELS,Vt),N.pixelStorei(N.UNPACK_SKIP_ROWS,Jt),N.pixelStorei(N.UNPACK_SKIP_IMAGES,te);let Es=T.isDataArrayTexture||T.isData3DTexture,Pe=k.isDataArrayTexture||k.isData3DTexture;if(T.isRenderTargetTexture||T.isDepthTexture){let zn=Tt.get(T),es=Tt.get(k),Pn=Tt.get(zn.__renderTarget),si=Tt.get(es.__renderTarget);Dt.bindFramebuffer(N.READ_FRAMEBUFFER,Pn.__webglFramebuffer),Dt.bindFramebuffer(N.DRAW_FRAMEBUFFER,si.__webglFramebuffer);for(let Jn=0;Jn<Ht;Jn++)Es&&N.framebufferTextureLayer(N.READ_FRAMEBUFFER,N.COLOR_ATTACHMENT0,Tt.get(T).__webglTexture,H,te+Jn),T.isDepthTexture?(Pe&&N.framebufferTextureLayer(N.DRAW_FRAMEBUFFER,N.COLOR_ATTACHMENT0,Tt.get(k).__webglTexture,H,be+Jn),N.blitFramebuffer(Vt,Jt,mt,Et,Gt,ue,mt,Et,N.DEPTH_BUFFER_BIT,N.NEAREST)):Pe?N.copyTexSubImage3D(Nt,H,Gt,ue,be+Jn,Vt,Jt,mt,Et):N.copyTexSubImage2D(Nt,H,Gt,ue,be+Jn,Vt,Jt,mt,Et);Dt.bindFramebuffer(N.READ_FRAMEBUFFER,null),Dt.bindFramebuffer(N.DRAW_FRAMEBUFFER,null)}else Pe?T.isDataTexture||T.isData3DTexture?N.texSubImage3D(Nt,H,Gt,ue,be,mt,Et,Ht,on,_e,Ee.data):k.isCompressedArrayTexture?N.compressedTexSubImage3D(Nt,H,Gt,ue,be,mt,Et,Ht,on,Ee.data):N.texSubImage3D(Nt,H,Gt,ue,be,mt,Et,Ht,on,_e,Ee):T.isDataTexture?N.texSubImage2D(N.TEXTURE_2D,H,Gt,ue,mt,Et,on,_e,Ee.data):T.isCompressedTexture?N.compressedTexSubImage2D(N.TEXTURE_2D,H,Gt,ue,Ee.width,Ee.height,on,Ee.data):N.texSubImage2D(N.TEXTURE_2D,H,Gt,ue,mt,Et,on,_e,Ee);N.pixelStorei(N.UNPACK_ROW_LENGTH,Zn),N.pixelStorei(N.UNPACK_IMAGE_HEIGHT,xe),N.pixelStorei(N.UNPACK_SKIP_PIXELS,yn),N.pixelStorei(N.UNPACK_SKIP_ROWS,Bi),N.pixelStorei(N.UNPACK_SKIP_IMAGES,vn),H===0&&k.generateMipmaps&&N.generateMipmap(Nt),Dt.unbindTexture()},this.copyTextureToTexture3D=function(T,k,X=null,tt=null,H=0){return T.isTexture!==!0&&(Do("WebGLRenderer: copyTextureToTexture3D function signature has changed."),X=arguments[0]||null,tt=arguments[1]||null,T=arguments[2],k=arguments[3],H=arguments[4]||0),Do('WebGLRenderer: copyTextureToTexture3D function has been deprecated. Use "copyTextureToTexture" instead.'),this.copyTextureToTexture(T,k,X,tt,H)},this.initRenderTarget=function(T){Tt.get(T).__webglFramebuffer===void 0&&P.setupRenderTarget(T)},this.initTexture=function(T){T.isCubeTexture?P.setTextureCube(T,0):T.isData3DTexture?P.setTexture3D(T,0):T.isDataArrayTexture||T.isCompressedArrayTexture?P.setTexture2DArray(T,0):P.setTexture2D(T,0),Dt.unbindTexture()},this.resetState=function(){C=0,R=0,L=null,Dt.reset(),Me.reset()},typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}get coordinateSystem(){return Zi}get outputColorSpace(){return this._outputColorSpace}set outputColorSpace(t){this._outputColorSpace=t;let e=this.getContext();e.drawingBufferColorspace=ye._getDrawingBufferColorSpace(t),e.unpackColorSpace=ye._getUnpackColorSpace()}};var pl=class extends Rn{constructor(){super(),this.isScene=!0,this.type="Scene",this.background=null,this.environment=null,this.fog=null,this.backgroundBlurriness=0,this.backgroundIntensity=1,this.backgroundRotation=new Li,this.environmentIntensity=1,this.environmentRotation=new Li,this.overrideMaterial=null,typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("observe",{detail:this}))}copy(t,e){return super.copy(t,e),t.background!==null&&(this.background=t.background.clone()),t.environment!==null&&(this.environment=t.environment.clone()),t.fog!==null&&(this.fog=t.fog.clone()),this.backgroundBlurriness=t.backgroundBlurriness,this.backgroundIntensity=t.backgroundIntensity,this.backgroundRotation.copy(t.backgroundRotation),this.environmentIntensity=t.environmentIntensity,this.environmentRotation.copy(t.environmentRotation),t.overrideMaterial!==null&&(this.overrideMaterial=t.overrideMaterial.clone()),this.matrixAutoUpdate=t.matrixAutoUpdate,this}toJSON(t){let e=super.toJSON(t);return this.fog!==null&&(e.object.fog=this.fog.toJSON()),this.backgroundBlurriness>0&&(e.object.backgroundBlurriness=this.backgroundBlurriness),this.backgroundIntensity!==1&&(e.object.backgroundIntensity=this.backgroundIntensity),e.object.backgroundRotation=this.backgroundRotation.toArray(),this.environmentIntensity!==1&&(e.object.environmentIntensity=this.environmentIntensity),e.object.environmentRotation=this.environmentRotation.toArray(),e}};var io=class extends Ss{static get type(){return"LineBasicMaterial"}constructor(t){super(),this.isLineBasicMaterial=!0,this.color=new pe(16777215),this.map=null,this.linewidth=1,this.linecap="round",this.linejoin="round",this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.color.copy(t.color),this.map=t.map,this.linewidth=t.linewidth,this.linecap=t.linecap,this.linejoin=t.linejoin,this.fog=t.fog,this}},ml=new Y,gl=new Y,am=new Ge,Lo=new to,Xa=new Qr,lh=new Y,lm=new Y,Ho=class extends Rn{constructor(t=new Bn,e=new io){super(),this.isLine=!0,this.type="Line",this.geometry=t,this.material=e,this.updateMorphTargets()}copy(t,e){return super.copy(t,e),this.material=Array.isArray(t.material)?t.material.slice():t.material,this.geometry=t.geometry,this}computeLineDistances(){let t=this.geometry;if(t.index===null){let e=t.attributes.position,n=[0];for(let s=1,r=e.count;s<r;s++)ml.fromBufferAttribute(e,s-1),gl.fromBufferAttribute(e,s),n[s]=n[s-1],n[s]+=ml.distanceTo(gl);t.setAttribute("lineDistance",new On(n,1))}else console.warn("THREE.Line.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}raycast(t,e){let n=this.geometry,s=this.matrixWorld,r=t.params.Line.threshold,o=n.drawRange;if(n.boundingSphere===null&&n.computeBoundingSphere(),Xa.copy(n.boundingSphere),Xa.applyMatrix4(s),Xa.radius+=r,t.ray.intersectsSphere(Xa)===!1)return;am.copy(s).invert(),Lo.copy(t.ray).applyMatrix4(am);let a=r/((this.scale.x+this.scale.y+this.scale.z)/3),l=a*a,c=this.isLineSegments?2:1,u=n.index,h=n.attributes.position;if(u!==null){let p=Math.max(0,o.start),_=Math.min(u.count,o.start+o.count);for(let g=p,m=_-1;g<m;g+=c){let d=u.getX(g),S=u.getX(g+1),v=qa(this,t,Lo,l,d,S);v&&e.push(v)}if(this.isLineLoop){let g=u.getX(_-1),m=u.getX(p),d=qa(this,t,Lo,l,g,m);d&&e.push(d)}}else{let p=Math.max(0,o.start),_=Math.min(h.count,o.start+o.count);for(let g=p,m=_-1;g<m;g+=c){let d=qa(this,t,Lo,l,g,g+1);d&&e.push(d)}if(this.isLineLoop){let g=qa(this,t,Lo,l,_-1,p);g&&e.push(g)}}}updateMorphTargets(){let e=this.geometry.morphAttributes,n=Object.keys(e);if(n.length>0){let s=e[n[0]];if(s!==void 0){this.morphTargetInfluences=[],this.morphTargetDictionary={};for(let r=0,o=s.length;r<o;r++){let a=s[r].name||String(r);this.morphTargetInfluences.push(0),this.morphTargetDictionary[a]=r}}}}};function qa(i,t,e,n,s,r){let o=i.geometry.attributes.position;if(ml.fromBufferAttribute(o,s),gl.fromBufferAttribute(o,r),e.distanceSqToSegment(ml,gl,lh,lm)>n)return;lh.applyMatrix4(i.matrixWorld);let l=t.ray.origin.distanceTo(lh);if(!(l<t.near||l>t.far))return{distance:l,point:lm.clone().applyMatrix4(i.matrixWorld),index:s,face:null,faceIndex:null,barycoord:null,object:i}}var cm=new Y,hm=new Y,_l=class extends Ho{constructor(t,e){super(t,e),this.isLineSegments=!0,this.type="LineSegments"}computeLineDistances(){let t=this.geometry;if(t.index===null){let e=t.attributes.position,n=[];for(let s=0,r=e.count;s<r;s+=2)cm.fromBufferAttribute(e,s),hm.fromBufferAttribute(e,s+1),n[s]=s===0?0:n[s-1],n[s+1]=n[s]+cm.distanceTo(hm);t.setAttribute("lineDistance",new On(n,1))}else console.warn("THREE.LineSegments.computeLineDistances(): Computation only possible with non-indexed BufferGeometry.");return this}};var xl=class i extends Bn{constructor(t=1,e=32,n=16,s=0,r=Math.PI*2,o=0,a=Math.PI){super(),this.type="SphereGeometry",this.parameters={radius:t,widthSegments:e,heightSegments:n,phiStart:s,phiLength:r,thetaStart:o,thetaLength:a},e=Math.max(3,Math.floor(e)),n=Math.max(2,Math.floor(n));let l=Math.min(o+a,Math.PI),c=0,u=[],f=new Y,h=new Y,p=[],_=[],g=[],m=[];for(let d=0;d<=n;d++){let S=[],v=d/n,y=0;d===0&&o===0?y=.5/e:d===n&&l===Math.PI&&(y=-.5/e);for(let I=0;I<=e;I++){let C=I/e;f.x=-t*Math.cos(s+C*r)*Math.sin(o+v*a),f.y=t*Math.cos(o+v*a),f.z=t*Math.sin(s+C*r)*Math.sin(o+v*a),_.push(f.x,f.y,f.z),h.copy(f).normalize(),g.push(h.x,h.y,h.z),m.push(C+y,1-v),S.push(c++)}u.push(S)}for(let d=0;d<n;d++)for(let S=0;S<e;S++){let v=u[d][S+1],y=u[d][S],I=u[d+1][S],C=u[d+1][S+1];(d!==0||o>0)&&p.push(v,y,C),(d!==n-1||l<Math.PI)&&p.push(y,I,C)}this.setIndex(p),this.setAttribute("position",new On(_,3)),this.setAttribute("normal",new On(g,3)),this.setAttribute("uv",new On(m,2))}copy(t){return super.copy(t),this.parameters=Object.assign({},t.parameters),this}static fromJSON(t){return new i(t.radius,t.widthSegments,t.heightSegments,t.phiStart,t.phiLength,t.thetaStart,t.thetaLength)}};var Go=class extends Ss{static get type(){return"MeshStandardMaterial"}constructor(t){super(),this.isMeshStandardMaterial=!0,this.defines={STANDARD:""},this.color=new pe(16777215),this.roughness=1,this.metalness=0,this.map=null,this.lightMap=null,this.lightMapIntensity=1,this.aoMap=null,this.aoMapIntensity=1,this.emissive=new pe(0),this.emissiveIntensity=1,this.emissiveMap=null,this.bumpMap=null,this.bumpScale=1,this.normalMap=null,this.normalMapType=Tm,this.normalScale=new se(1,1),this.displacementMap=null,this.displacementScale=1,this.displacementBias=0,this.roughnessMap=null,this.metalnessMap=null,this.alphaMap=null,this.envMap=null,this.envMapRotation=new Li,this.envMapIntensity=1,this.wireframe=!1,this.wireframeLinewidth=1,this.wireframeLinecap="round",this.wireframeLinejoin="round",this.flatShading=!1,this.fog=!0,this.setValues(t)}copy(t){return super.copy(t),this.defines={STANDARD:""},this.color.copy(t.color),this.roughness=t.roughness,this.metalness=t.metalness,this.map=t.map,this.lightMap=t.lightMap,this.lightMapIntensity=t.lightMapIntensity,this.aoMap=t.aoMap,this.aoMapIntensity=t.aoMapIntensity,this.emissive.copy(t.emissive),this.emissiveMap=t.emissiveMap,this.emissiveIntensity=t.emissiveIntensity,this.bumpMap=t.bumpMap,this.bumpScale=t.bumpScale,this.normalMap=t.normalMap,this.normalMapType=t.normalMapType,this.normalScale.copy(t.normalScale),this.displacementMap=t.displacementMap,this.displacementScale=t.displacementScale,this.displacementBias=t.displacementBias,this.roughnessMap=t.roughnessMap,this.metalnessMap=t.metalnessMap,this.alphaMap=t.alphaMap,this.envMap=t.envMap,this.envMapRotation.copy(t.envMapRotation),this.envMapIntensity=t.envMapIntensity,this.wireframe=t.wireframe,this.wireframeLinewidth=t.wireframeLinewidth,this.wireframeLinecap=t.wireframeLinecap,this.wireframeLinejoin=t.wireframeLinejoin,this.flatShading=t.flatShading,this.fog=t.fog,this}};function Ya(i,t,e){return!i||!e&&i.constructor===t?i:typeof t.BYTES_PER_ELEMENT=="number"?new t(i):Array.prototype.slice.call(i)}function Mb(i){return ArrayBuffer.isView(i)&&!(i instanceof DataView)}var so=class{constructor(t,e,n,s){this.parameterPositions=t,this._cachedIndex=0,this.resultBuffer=s!==void 0?s:new e.constructor(n),this.sampleValues=e,this.valueSize=n,this.settings=null,this.DefaultSettings_={}}evaluate(t){let e=this.parameterPositions,n=this._cachedIndex,s=e[n],r=e[n-1];n:{t:{let o;e:{i:if(!(t<s)){for(let a=n+2;;){if(s===void 0){if(t<r)break i;return n=e.length,this._cachedIndex=n,this.copySampleValue_(n-1)}if(n===a)break;if(r=s,s=e[++n],t<s)break t}o=e.length;break e}if(!(t>=r)){let a=e[1];t<a&&(n=2,r=a);for(let l=n-2;;){if(r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(n===l)break;if(s=r,r=e[--n-1],t>=r)break t}o=n,n=0;break e}break n}for(;n<o;){let a=n+o>>>1;t<e[a]?o=a:n=a+1}if(s=e[n],r=e[n-1],r===void 0)return this._cachedIndex=0,this.copySampleValue_(0);if(s===void 0)return n=e.length,this._cachedIndex=n,this.copySampleValue_(n-1)}this._cachedIndex=n,this.intervalChanged_(n,r,s)}return this.interpolate_(n,r,t,s)}getSettings_(){return this.settings||this.DefaultSettings_}copySampleValue_(t){let e=this.resultBuffer,n=this.sampleValues,s=this.valueSize,r=t*s;for(let o=0;o!==s;++o)e[o]=n[r+o];return e}interpolate_(){throw new Error("call to abstract method")}intervalChanged_(){}},fu=class extends so{constructor(t,e,n,s){super(t,e,n,s),this._weightPrev=-0,this._offsetPrev=-0,this._weightNext=-0,this._offsetNext=-0,this.DefaultSettings_={endingStart:hp,endingEnd:hp}}intervalChanged_(t,e,n){let s=this.parameterPositions,r=t-2,o=t+1,a=s[r],l=s[o];if(a===void 0)switch(this.getSettings_().endingStart){case up:r=t,a=2*e-n;break;case fp:r=s.length-2,a=e+s[r]-s[r+1];break;default:r=t,a=n}if(l===void 0)switch(this.getSettings_().endingEnd){case up:o=t,l=2*n-e;break;case fp:o=1,l=n+s[1]-s[0];break;default:o=t-1,l=e}let c=(n-e)*.5,u=this.valueSize;this._weightPrev=c/(e-a),this._weightNext=c/(l-n),this._offsetPrev=r*u,this._offsetNext=o*u}interpolate_(t,e,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=t*a,c=l-a,u=this._offsetPrev,f=this._offsetNext,h=this._weightPrev,p=this._weightNext,_=(n-e)/(s-e),g=_*_,m=g*_,d=-h*m+2*h*g-h*_,S=(1+h)*m+(-1.5-2*h)*g+(-.5+h)*_+1,v=(-1-p)*m+(1.5+p)*g+.5*_,y=p*m-p*g;for(let I=0;I!==a;++I)r[I]=d*o[u+I]+S*o[c+I]+v*o[l+I]+y*o[f+I];return r}},du=class extends so{constructor(t,e,n,s){super(t,e,n,s)}interpolate_(t,e,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=t*a,c=l-a,u=(n-e)/(s-e),f=1-u;for(let h=0;h!==a;++h)r[h]=o[c+h]*f+o[l+h]*u;return r}},pu=class extends so{constructor(t,e,n,s){super(t,e,n,s)}interpolate_(t){return this.copySampleValue_(t-1)}},vi=class{constructor(t,e,n,s){if(t===void 0)throw new Error("THREE.KeyframeTrack: track name is undefined");if(e===void 0||e.length===0)throw new Error("THREE.KeyframeTrack: no keyframes in track named "+t);this.name=t,this.times=Ya(e,this.TimeBufferType),this.values=Ya(n,this.ValueBufferType),this.setInterpolation(s||this.DefaultInterpolation)}static toJSON(t){let e=t.constructor,n;if(e.toJSON!==this.toJSON)n=e.toJSON(t);else{n={name:t.name,times:Ya(t.times,Array),values:Ya(t.values,Array)};let s=t.getInterpolation();s!==t.DefaultInterpolation&&(n.interpolation=s)}return n.type=t.ValueTypeName,n}InterpolantFactoryMethodDiscrete(t){return new pu(this.times,this.values,this.getValueSize(),t)}InterpolantFactoryMethodLinear(t){return new du(this.times,this.values,this.getValueSize(),t)}InterpolantFactoryMethodSmooth(t){return new fu(this.times,this.values,this.getValueSize(),t)}setInterpolation(t){let e;switch(t){case Qa:e=this.InterpolantFactoryMethodDiscrete;break;case Zh:e=this.InterpolantFactoryMethodLinear;break;case Nc:e=this.InterpolantFactoryMethodSmooth;break}if(e===void 0){let n="unsupported interpolation for "+this.ValueTypeName+" keyframe track named "+this.name;if(this.createInterpolant===void 0)if(t!==this.DefaultInterpolation)this.setInterpolation(this.DefaultInterpolation);else throw new Error(n);return console.warn("THREE.KeyframeTrack:",n),this}return this.createInterpolant=e,this}getInterpolation(){switch(this.createInterpolant){case this.InterpolantFactoryMethodDiscrete:return Qa;case this.InterpolantFactoryMethodLinear:return Zh;case this.InterpolantFactoryMethodSmooth:return Nc}}getValueSize(){return this.values.length/this.times.length}shift(t){if(t!==0){let e=this.times;for(let n=0,s=e.length;n!==s;++n)e[n]+=t}return this}scale(t){if(t!==1){let e=this.times;for(let n=0,s=e.length;n!==s;++n)e[n]*=t}return this}trim(t,e){let n=this.times,s=n.length,r=0,o=s-1;for(;r!==s&&n[r]<t;)++r;for(;o!==-1&&n[o]>e;)--o;if(++o,r!==0||o!==s){r>=o&&(o=Math.max(o,1),r=o-1);let a=this.getValueSize();this.times=n.slice(r,o),this.values=this.values.slice(r*a,o*a)}return this}validate(){let t=!0,e=this.getValueSize();e-Math.floor(e)!==0&&(console.error("THREE.KeyframeTrack: Invalid value size in track.",this),t=!1);let n=this.times,s=this.values,r=n.length;r===0&&(console.error("THREE.KeyframeTrack: Track is empty.",this),t=!1);let o=null;for(let a=0;a!==r;a++){let l=n[a];if(typeof l=="number"&&isNaN(l)){console.error("THREE.KeyframeTrack: Time is not a valid number.",this,a,l),t=!1;break}if(o!==null&&o>l){console.error("THREE.KeyframeTrack: Out of order keys.",this,a,l,o),t=!1;break}o=l}if(s!==void 0&&Mb(s))for(let a=0,l=s.length;a!==l;++a){let c=s[a];if(isNaN(c)){console.error("THREE.KeyframeTrack: Value is not a valid number.",this,a,c),t=!1;break}}return t}optimize(){let t=this.times.slice(),e=this.values.slice(),n=this.getValueSize(),s=this.getInterpolation()===Nc,r=t.length-1,o=1;for(let a=1;a<r;++a){let l=!1,c=t[a],u=t[a+1];if(c!==u&&(a!==1||c!==t[0]))if(s)l=!0;else{let f=a*n,h=f-n,p=f+n;for(let _=0;_!==n;++_){let g=e[f+_];if(g!==e[h+_]||g!==e[p+_]){l=!0;break}}}if(l){if(a!==o){t[o]=t[a];let f=a*n,h=o*n;for(let p=0;p!==n;++p)e[h+p]=e[f+p]}++o}}if(r>0){t[o]=t[r];for(let a=r*n,l=o*n,c=0;c!==n;++c)e[l+c]=e[a+c];++o}return o!==t.length?(this.times=t.slice(0,o),this.values=e.slice(0,o*n)):(this.times=t,this.values=e),this}clone(){let t=this.times.slice(),e=this.values.slice(),n=this.constructor,s=new n(this.name,t,e);return s.createInterpolant=this.createInterpolant,s}};vi.prototype.TimeBufferType=Float32Array;vi.prototype.ValueBufferType=Float32Array;vi.prototype.DefaultInterpolation=Zh;var Qs=class extends vi{constructor(t,e,n){super(t,e,n)}};Qs.prototype.ValueTypeName="bool";Qs.prototype.ValueBufferType=Array;Qs.prototype.DefaultInterpolation=Qa;Qs.prototype.InterpolantFactoryMethodLinear=void 0;Qs.prototype.InterpolantFactoryMethodSmooth=void 0;var mu=class extends vi{};mu.prototype.ValueTypeName="color";var gu=class extends vi{};gu.prototype.ValueTypeName="number";var _u=class extends so{constructor(t,e,n,s){super(t,e,n,s)}interpolate_(t,e,n,s){let r=this.resultBuffer,o=this.sampleValues,a=this.valueSize,l=(n-e)/(s-e),c=t*a;for(let u=c+a;c!==u;c+=4)yi.slerpFlat(r,0,o,c-a,o,c,l);return r}},yl=class extends vi{InterpolantFactoryMethodLinear(t){return new _u(this.times,this.values,this.getValueSize(),t)}};yl.prototype.ValueTypeName="quaternion";yl.prototype.InterpolantFactoryMethodSmooth=void 0;var tr=class extends vi{constructor(t,e,n){super(t,e,n)}};tr.prototype.ValueTypeName="string";tr.prototype.ValueBufferType=Array;tr.prototype.DefaultInterpolation=Qa;tr.prototype.InterpolantFactoryMethodLinear=void 0;tr.prototype.InterpolantFactoryMethodSmooth=void 0;var xu=class extends vi{};xu.prototype.ValueTypeName="vector";var yu=class{constructor(t,e,n){let s=this,r=!1,o=0,a=0,l,c=[];this.onStart=void 0,this.onLoad=t,this.onProgress=e,this.onError=n,this.itemStart=function(u){a++,r===!1&&s.onStart!==void 0&&s.onStart(u,o,a),r=!0},this.itemEnd=function(u){o++,s.onProgress!==void 0&&s.onProgress(u,o,a),o===a&&(r=!1,s.onLoad!==void 0&&s.onLoad())},this.itemError=function(u){s.onError!==void 0&&s.onError(u)},this.resolveURL=function(u){return l?l(u):u},this.setURLModifier=function(u){return l=u,this},this.addHandler=function(u,f){return c.push(u,f),this},this.removeHandler=function(u){let f=c.indexOf(u);return f!==-1&&c.splice(f,2),this},this.getHandler=function(u){for(let f=0,h=c.length;f<h;f+=2){let p=c[f],_=c[f+1];if(p.global&&(p.lastIndex=0),p.test(u))return _}return null}}},Sb=new yu,vu=class{constructor(t){this.manager=t!==void 0?t:Sb,this.crossOrigin="anonymous",this.withCredentials=!1,this.path="",this.resourcePath="",this.requestHeader={}}load(){}loadAsync(t,e){let n=this;return new Promise(function(s,r){n.load(t,s,e,r)})}parse(){}setCrossOrigin(t){return this.crossOrigin=t,this}setWithCredentials(t){return this.withCredentials=t,this}setPath(t){return this.path=t,this}setResourcePath(t){return this.resourcePath=t,this}setRequestHeader(t){return this.requestHeader=t,this}};vu.DEFAULT_MATERIAL_NAME="__DEFAULT";var vl=class extends Rn{constructor(t,e=1){super(),this.isLight=!0,this.type="Light",this.color=new pe(t),this.intensity=e}dispose(){}copy(t,e){return super.copy(t,e),this.color.copy(t.color),this.intensity=t.intensity,this}toJSON(t){let e=super.toJSON(t);return e.object.color=this.color.getHex(),e.object.intensity=this.intensity,this.groundColor!==void 0&&(e.object.groundColor=this.groundColor.getHex()),this.distance!==void 0&&(e.object.distance=this.distance),this.angle!==void 0&&(e.object.angle=this.angle),this.decay!==void 0&&(e.object.decay=this.decay),this.penumbra!==void 0&&(e.object.penumbra=this.penumbra),this.shadow!==void 0&&(e.object.shadow=this.shadow.toJSON()),this.target!==void 0&&(e.object.target=this.target.uuid),e}};var ch=new Ge,um=new Y,fm=new Y,Mu=class{constructor(t){this.camera=t,this.intensity=1,this.bias=0,this.normalBias=0,this.radius=1,this.blurSamples=8,this.mapSize=new se(512,512),this.map=null,this.mapPass=null,this.matrix=new Ge,this.autoUpdate=!0,this.needsUpdate=!1,this._frustum=new Vo,this._frameExtents=new se(1,1),this._viewportCount=1,this._viewports=[new He(0,0,1,1)]}getViewportCount(){return this._viewportCount}getFrustum(){return this._frustum}updateMatrices(t){let e=this.camera,n=this.matrix;um.setFromMatrixPosition(t.matrixWorld),e.position.copy(um),fm.setFromMatrixPosition(t.target.matrixWorld),e.lookAt(fm),e.updateMatrixWorld(),ch.multiplyMatrices(e.projectionMatrix,e.matrixWorldInverse),this._frustum.setFromProjectionMatrix(ch),n.set(.5,0,0,.5,0,.5,0,.5,0,0,.5,.5,0,0,0,1),n.multiply(ch)}getViewport(t){return this._viewports[t]}getFrameExtents(){return this._frameExtents}dispose(){this.map&&this.map.dispose(),this.mapPass&&this.mapPass.dispose()}copy(t){return this.camera=t.camera.clone(),this.intensity=t.intensity,this.bias=t.bias,this.radius=t.radius,this.mapSize.copy(t.mapSize),this}clone(){return new this.constructor().copy(this)}toJSON(){let t={};return this.intensity!==1&&(t.intensity=this.intensity),this.bias!==0&&(t.bias=this.bias),this.normalBias!==0&&(t.normalBias=this.normalBias),this.radius!==1&&(t.radius=this.radius),(this.mapSize.x!==512||this.mapSize.y!==512)&&(t.mapSize=this.mapSize.toArray()),t.camera=this.camera.toJSON(!1).object,delete t.camera.matrix,t}};var Su=class extends Mu{constructor(){super(new hl(-5,5,5,-5,.5,500)),this.isDirectionalLightShadow=!0}},Ml=class extends vl{constructor(t,e){super(t,e),this.isDirectionalLight=!0,this.type="DirectionalLight",this.position.copy(Rn.DEFAULT_UP),this.updateMatrix(),this.target=new Rn,this.shadow=new Su}dispose(){this.shadow.dispose()}copy(t){return super.copy(t),this.target=t.target.clone(),this.shadow=t.shadow.clone(),this}},Sl=class extends vl{constructor(t,e){super(t,e),this.isAmbientLight=!0,this.type="AmbientLight"}};var Du="\\[\\]\\.:\\/",bb=new RegExp("["+Du+"]","g"),Uu="[^"+Du+"]",wb="[^"+Du.replace("\\.","")+"]",Eb=/((?:WC+[\/:])*)/.source.replace("WC",Uu),Tb=/(WCOD+)?/.source.replace("WCOD",wb),Ab=/(?:\.(WC+)(?:\[(.+)\])?)?/.source.replace("WC",Uu),Cb=/\.(WC+)(?:\[(.+)\])?/.source.replace("WC",Uu),Rb=new RegExp("^"+Eb+Tb+Ab+Cb+"$"),Pb=["material","materials","bones","map"],bu=class{constructor(t,e,n){let s=n||ke.parseTrackName(e);this._targetGroup=t,this._bindings=t.subscribe_(e,s)}getValue(t,e){this.bind();let n=this._targetGroup.nCachedObjects_,s=this._bindings[n];s!==void 0&&s.getValue(t,e)}setValue(t,e){let n=this._bindings;for(let s=this._targetGroup.nCachedObjects_,r=n.length;s!==r;++s)n[s].setValue(t,e)}bind(){let t=this._bindings;for(let e=this._targetGroup.nCachedObjects_,n=t.length;e!==n;++e)t[e].bind()}unbind(){let t=this._bindings;for(let e=this._targetGroup.nCachedObjects_,n=t.length;e!==n;++e)t[e].unbind()}},ke=class i{constructor(t,e,n){this.path=e,this.parsedPath=n||i.parseTrackName(e),this.node=i.findNode(t,this.parsedPath.nodeName),this.rootNode=t,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}static create(t,e,n){return t&&t.isAnimationObjectGroup?new i.Composite(t,e,n):new i(t,e,n)}static sanitizeNodeName(t){return t.replace(/\s/g,"_").replace(bb,"")}static parseTrackName(t){let e=Rb.exec(t);if(e===null)throw new Error("PropertyBinding: Cannot parse trackName: "+t);let n={nodeName:e[2],objectName:e[3],objectIndex:e[4],propertyName:e[5],propertyIndex:e[6]},s=n.nodeName&&n.nodeName.lastIndexOf(".");if(s!==void 0&&s!==-1){let r=n.nodeName.substring(s+1);Pb.indexOf(r)!==-1&&(n.nodeName=n.nodeName.substring(0,s),n.objectName=r)}if(n.propertyName===null||n.propertyName.length===0)throw new Error("PropertyBinding: can not parse propertyName from trackName: "+t);return n}static findNode(t,e){if(e===void 0||e===""||e==="."||e===-1||e===t.name||e===t.uuid)return t;if(t.skeleton){let n=t.skeleton.getBoneByName(e);if(n!==void 0)return n}if(t.children){let n=function(r){for(let o=0;o<r.length;o++){let a=r[o];if(a.name===e||a.uuid===e)return a;let l=n(a.children);if(l)return l}return null},s=n(t.children);if(s)return s}return null}_getValue_unavailable(){}_setValue_unavailable(){}_getValue_direct(t,e){t[e]=this.targetObject[this.propertyName]}_getValue_array(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)t[e++]=n[s]}_getValue_arrayElement(t,e){t[e]=this.resolvedProperty[this.propertyIndex]}_getValue_toArray(t,e){this.resolvedProperty.toArray(t,e)}_setValue_direct(t,e){this.targetObject[this.propertyName]=t[e]}_setValue_direct_setNeedsUpdate(t,e){this.targetObject[this.propertyName]=t[e],this.targetObject.needsUpdate=!0}_setValue_direct_setMatrixWorldNeedsUpdate(t,e){this.targetObject[this.propertyName]=t[e],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_array(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=t[e++]}_setValue_array_setNeedsUpdate(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=t[e++];this.targetObject.needsUpdate=!0}_setValue_array_setMatrixWorldNeedsUpdate(t,e){let n=this.resolvedProperty;for(let s=0,r=n.length;s!==r;++s)n[s]=t[e++];this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_arrayElement(t,e){this.resolvedProperty[this.propertyIndex]=t[e]}_setValue_arrayElement_setNeedsUpdate(t,e){this.resolvedProperty[this.propertyIndex]=t[e],this.targetObject.needsUpdate=!0}_setValue_arrayElement_setMatrixWorldNeedsUpdate(t,e){this.resolvedProperty[this.propertyIndex]=t[e],this.targetObject.matrixWorldNeedsUpdate=!0}_setValue_fromArray(t,e){this.resolvedProperty.fromArray(t,e)}_setValue_fromArray_setNeedsUpdate(t,e){this.resolvedProperty.fromArray(t,e),this.targetObject.needsUpdate=!0}_setValue_fromArray_setMatrixWorldNeedsUpdate(t,e){this.resolvedProperty.fromArray(t,e),this.targetObject.matrixWorldNeedsUpdate=!0}_getValue_unbound(t,e){this.bind(),this.getValue(t,e)}_setValue_unbound(t,e){this.bind(),this.setValue(t,e)}bind(){let t=this.node,e=this.parsedPath,n=e.objectName,s=e.propertyName,r=e.propertyIndex;if(t||(t=i.findNode(this.rootNode,e.nodeName),this.node=t),this.getValue=this._getValue_unavailable,this.setValue=this._setValue_unavailable,!t){console.warn("THREE.PropertyBinding: No target node found for track: "+this.path+".");return}if(n){let c=e.objectIndex;switch(n){case"materials":if(!t.material){console.error("THREE.PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!t.material.materials){console.error("THREE.PropertyBinding: Can not bind to material.materials as node.material does not have a materials array.",this);return}t=t.material.materials;break;case"bones":if(!t.skeleton){console.error("THREE.PropertyBinding: Can not bind to bones as node does not have a skeleton.",this);return}t=t.skeleton.bones;for(let u=0;u<t.length;u++)if(t[u].name===c){c=u;break}break;case"map":if("map"in t){t=t.map;break}if(!t.material){console.error("THREE.PropertyBinding: Can not bind to material as node does not have a material.",this);return}if(!t.material.map){console.error("THREE.PropertyBinding: Can not bind to material.map as node.material does not have a map.",this);return}t=t.material.map;break;default:if(t[n]===void 0){console.error("THREE.PropertyBinding: Can not bind to objectName of node undefined.",this);return}t=t[n]}if(c!==void 0){if(t[c]===void 0){console.error("THREE.PropertyBinding: Trying to bind to objectIndex of objectName, but is undefined.",this,t);return}t=t[c]}}let o=t[s];if(o===void 0){let c=e.nodeName;console.error("THREE.PropertyBinding: Trying to update property for track: "+c+"."+s+" but it wasn't found.",t);return}let a=this.Versioning.None;this.targetObject=t,t.needsUpdate!==void 0?a=this.Versioning.NeedsUpdate:t.matrixWorldNeedsUpdate!==void 0&&(a=this.Versioning.MatrixWorldNeedsUpdate);let l=this.BindingType.Direct;if(r!==void 0){if(s==="morphTargetInfluences"){if(!t.geometry){console.error("THREE.PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.",this);return}if(!t.geometry.morphAttributes){console.error("THREE.PropertyBinding: Can not bind to morphTargetInfluences because node does not have a geometry.morphAttributes.",this);return}t.morphTargetDictionary[r]!==void 0&&(r=t.morphTargetDictionary[r])}l=this.BindingType.ArrayElement,this.resolvedProperty=o,this.propertyIndex=r}else o.fromArray!==void 0&&o.toArray!==void 0?(l=this.BindingType.HasFromToArray,this.resolvedProperty=o):Array.isArray(o)?(l=this.BindingType.EntireArray,this.resolvedProperty=o):this.propertyName=s;this.getValue=this.GetterByBindingType[l],this.setValue=this.SetterByBindingTypeAndVersioning[l][a]}unbind(){this.node=null,this.getValue=this._getValue_unbound,this.setValue=this._setValue_unbound}};ke.Composite=bu;ke.prototype.BindingType={Direct:0,EntireArray:1,ArrayElement:2,HasFromToArray:3};ke.prototype.Versioning={None:0,NeedsUpdate:1,MatrixWorldNeedsUpdate:2};ke.prototype.GetterByBindingType=[ke.prototype._getValue_direct,ke.prototype._getValue_array,ke.prototype._getValue_arrayElement,ke.prototype._getValue_toArray];ke.prototype.SetterByBindingTypeAndVersioning=[[ke.prototype._setValue_direct,ke.prototype._setValue_direct_setNeedsUpdate,ke.prototype._setValue_direct_setMatrixWorldNeedsUpdate],[ke.prototype._setValue_array,ke.prototype._setValue_array_setNeedsUpdate,ke.prototype._setValue_array_setMatrixWorldNeedsUpdate],[ke.prototype._setValue_arrayElement,ke.prototype._setValue_arrayElement_setNeedsUpdate,ke.prototype._setValue_arrayElement_setMatrixWorldNeedsUpdate],[ke.prototype._setValue_fromArray,ke.prototype._setValue_fromArray_setNeedsUpdate,ke.prototype._setValue_fromArray_setMatrixWorldNeedsUpdate]];var Iw=new Float32Array(1);var Wo=class{constructor(t=1,e=0,n=0){return this.radius=t,this.phi=e,this.theta=n,this}set(t,e,n){return this.radius=t,this.phi=e,this.theta=n,this}copy(t){return this.radius=t.radius,this.phi=t.phi,this.theta=t.theta,this}makeSafe(){return this.phi=Math.max(1e-6,Math.min(Math.PI-1e-6,this.phi)),this}setFromVector3(t){return this.setFromCartesianCoords(t.x,t.y,t.z)}setFromCartesianCoords(t,e,n){return this.radius=Math.sqrt(t*t+e*e+n*n),this.radius===0?(this.theta=0,this.phi=0):(this.theta=Math.atan2(t,n),this.phi=Math.acos(xn(e/this.radius,-1,1))),this}clone(){return new this.constructor().copy(this)}};var bl=class extends Qi{constructor(t,e=null){super(),this.object=t,this.domElement=e,this.enabled=!0,this.state=-1,this.keys={},this.mouseButtons={LEFT:null,MIDDLE:null,RIGHT:null},this.touches={ONE:null,TWO:null}}connect(){}disconnect(){}dispose(){}update(){}};typeof __THREE_DEVTOOLS__<"u"&&__THREE_DEVTOOLS__.dispatchEvent(new CustomEvent("register",{detail:{revision:wu}}));typeof window<"u"&&(window.__THREE__?console.warn("WARNING: Multiple instances of Three.js being imported."):window.__THREE__=wu);var Fm={type:"change"},Ou={type:"start"},km={type:"end"},Al=new to,Bm=new gi,Ib=Math.cos(70*Cm.DEG2RAD),sn=new Y,kn=2*Math.PI,Re={NONE:-1,ROTATE:0,DOLLY:1,PAN:2,TOUCH_ROTATE:3,TOUCH_PAN:4,TOUCH_DOLLY_PAN:5,TOUCH_DOLLY_ROTATE:6},Nu=1e-6,Cl=class extends bl{constructor(t,e=null){super(t,e),this.state=Re.NONE,this.enabled=!0,this.target=new Y,this.cursor=new Y,this.minDistance=0,this.maxDistance=1/0,this.minZoom=0,this.maxZoom=1/0,this.minTargetRadius=0,this.maxTargetRadius=1/0,this.minPolarAngle=0,this.maxPolarAngle=Math.PI,this.minAzimuthAngle=-1/0,this.maxAzimuthAngle=1/0,this.enableDamping=!1,this.dampingFactor=.05,this.enableZoom=!0,this.zoomSpeed=1,this.enableRotate=!0,this.rotateSpeed=1,this.enablePan=!0,this.panSpeed=1,this.screenSpacePanning=!0,this.keyPanSpeed=7,this.zoomToCursor=!1,this.autoRotate=!1,this.autoRotateSpeed=2,this.keys={LEFT:"ArrowLeft",UP:"ArrowUp",RIGHT:"ArrowRight",BOTTOM:"ArrowDown"},this.mouseButtons={LEFT:er.ROTATE,MIDDLE:er.DOLLY,RIGHT:er.PAN},this.touches={ONE:nr.ROTATE,TWO:nr.DOLLY_PAN},this.target0=this.target.clone(),this.position0=this.object.position.clone(),this.zoom0=this.object.zoom,this._domElementKeyEvents=null,this._lastPosition=new Y,this._lastQuaternion=new yi,this._lastTargetPosition=new Y,this._quat=new yi().setFromUnitVectors(t.up,new Y(0,1,0)),this._quatInverse=this._quat.clone().invert(),this._spherical=new Wo,this._sphericalDelta=new Wo,this._scale=1,this._panOffset=new Y,this._rotateStart=new se,this._rotateEnd=new se,this._rotateDelta=new se,this._panStart=new se,this._panEnd=new se,this._panDelta=new se,this._dollyStart=new se,this._dollyEnd=new se,this._dollyDelta=new se,this._dollyDirection=new Y,this._mouse=new se,this._performCursorZoom=!1,this._pointers=[],this._pointerPositions={},this._controlActive=!1,this._onPointerMove=Db.bind(this),this._onPointerDown=Lb.bind(this),this._onPointerUp=Ub.bind(this),this._onContextMenu=Vb.bind(this),this._onMouseWheel=Fb.bind(this),this._onKeyDown=Bb.bind(this),this._onTouchStart=kb.bind(this),this._onTouchMove=zb.bind(this),this._onMouseDown=Nb.bind(this),this._onMouseMove=Ob.bind(this),this._interceptControlDown=Hb.bind(this),this._interceptControlUp=Gb.bind(this),this.domElement!==null&&this.connect(),this.update()}connect(){this.domElement.addEventListener("pointerdown",this._onPointerDown),this.domElement.addEventListener("pointercancel",this._onPointerUp),this.domElement.addEventListener("contextmenu",this._onContextMenu),this.domElement.addEventListener("wheel",this._onMouseWheel,{passive:!1}),this.domElement.getRootNode().addEventListener("keydown",this._interceptControlDown,{passive:!0,capture:!0}),this.domElement.style.touchAction="none"}disconnect(){this.domElement.removeEventListener("pointerdown",this._onPointerDown),this.domElement.removeEventListener("pointermove",this._onPointerMove),this.domElement.removeEventListener("pointerup",this._onPointerUp),this.domElement.removeEventListener("pointercancel",this._onPointerUp),this.domElement.removeEventListener("wheel",this._onMouseWheel),this.domElement.removeEventListener("contextmenu",this._onContextMenu),this.stopListenToKeyEvents(),this.domElement.getRootNode().removeEventListener("keydown",this._interceptControlDown,{capture:!0}),this.domElement.style.touchAction="auto"}dispose(){this.disconnect()}getPolarAngle(){return this._spherical.phi}getAzimuthalAngle(){return this._spherical.theta}getDistance(){return this.object.position.distanceTo(this.target)}listenToKeyEvents(t){t.addEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=t}stopListenToKeyEvents(){this._domElementKeyEvents!==null&&(this._domElementKeyEvents.removeEventListener("keydown",this._onKeyDown),this._domElementKeyEvents=null)}saveState(){this.target0.copy(this.target),this.position0.copy(this.object.position),this.zoom0=this.object.zoom}reset(){this.target.copy(this.target0),this.object.position.copy(this.position0),this.object.zoom=this.zoom0,this.object.updateProjectionMatrix(),this.dispatchEvent(Fm),this.update(),this.state=Re.NONE}update(t=null){let e=this.object.position;sn.copy(e).sub(this.target),sn.applyQuaternion(this._quat),this._spherical.setFromVector3(sn),this.autoRotate&&this.state===Re.NONE&&this._rotateLeft(this._getAutoRotationAngle(t)),this.enableDamping?(this._spherical.theta+=this._sphericalDelta.theta*this.dampingFactor,this._spherical.phi+=this._sphericalDelta.phi*this.dampingFactor):(this._spherical.theta+=this._sphericalDelta.theta,this._spherical.phi+=this._sphericalDelta.phi);let n=this.minAzimuthAngle,s=this.maxAzimuthAngle;isFinite(n)&&isFinite(s)&&(n<-Math.PI?n+=kn:n>Math.PI&&(n-=kn),s<-Math.PI?s+=kn:s>Math.PI&&(s-=kn),n<=s?this._spherical.theta=Math.max(n,Math.min(s,this._spherical.theta)):this._spherical.theta=this._spherical.theta>(n+s)/2?Math.max(n,this._spherical.theta):Math.min(s,this._spherical.theta)),this._spherical.phi=Math.max(this.minPolarAngle,Math.min(this.maxPolarAngle,this._spherical.phi)),this._spherical.makeSafe(),this.enableDamping===!0?this.target.addScaledVector(this._panOffset,this.dampingFactor):this.target.add(this._panOffset),this.target.sub(this.cursor),this.target.clampLength(this.minTargetRadius,this.maxTargetRadius),this.target.add(this.cursor);let r=!1;if(this.zoomToCursor&&this._performCursorZoom||this.object.isOrthographicCamera)this._spherical.radius=this._clampDistance(this._spherical.radius);else{let o=this._spherical.radius;this._spherical.radius=this._clampDistance(this._spherical.radius*this._scale),r=o!=this._spherical.radius}if(sn.setFromSpherical(this._spherical),sn.applyQuaternion(this._quatInverse),e.copy(this.target).add(sn),this.object.lookAt(this.target),this.enableDamping===!0?(this._sphericalDelta.theta*=1-this.dampingFactor,this._sphericalDelta.phi*=1-this.dampingFactor,this._panOffset.multiplyScalar(1-this.dampingFactor)):(this._sphericalDelta.set(0,0,0),this._panOffset.set(0,0,0)),this.zoomToCursor&&this._performCursorZoom){let o=null;if(this.object.isPerspectiveCamera){let a=sn.length();o=this._clampDistance(a*this._scale);let l=a-o;this.object.position.addScaledVector(this._dollyDirection,l),this.object.updateMatrixWorld(),r=!!l}else if(this.object.isOrthographicCamera){let a=new Y(this._mouse.x,this._mouse.y,0);a.unproject(this.object);let l=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),this.object.updateProjectionMatrix(),r=l!==this.object.zoom;let c=new Y(this._mouse.x,this._mouse.y,0);c.unproject(this.object),this.object.position.sub(c).add(a),this.object.updateMatrixWorld(),o=sn.length()}else console.warn("WARNING: OrbitControls.js encountered an unknown camera type - zoom to cursor disabled."),this.zoomToCursor=!1;o!==null&&(this.screenSpacePanning?this.target.set(0,0,-1).transformDirection(this.object.matrix).multiplyScalar(o).add(this.object.position):(Al.origin.copy(this.object.position),Al.direction.set(0,0,-1).transformDirection(this.object.matrix),Math.abs(this.object.up.dot(Al.direction))<Ib?this.object.lookAt(this.target):(Bm.setFromNormalAndCoplanarPoint(this.object.up,this.target),Al.intersectPlane(Bm,this.target))))}else if(this.object.isOrthographicCamera){let o=this.object.zoom;this.object.zoom=Math.max(this.minZoom,Math.min(this.maxZoom,this.object.zoom/this._scale)),o!==this.object.zoom&&(this.object.updateProjectionMatrix(),r=!0)}return this._scale=1,this._performCursorZoom=!1,r||this._lastPosition.distanceToSquared(this.object.position)>Nu||8*(1-this._lastQuaternion.dot(this.object.quaternion))>Nu||this._lastTargetPosition.distanceToSquared(this.target)>Nu?(this.dispatchEvent(Fm),this._lastPosition.copy(this.object.position),this._lastQuaternion.copy(this.object.quaternion),this._lastTargetPosition.copy(this.target),!0):!1}_getAutoRotationAngle(t){return t!==null?kn/60*this.autoRotateSpeed*t:kn/60/60*this.autoRotateSpeed}_getZoomScale(t){let e=Math.abs(t*.01);return Math.pow(.95,this.zoomSpeed*e)}_rotateLeft(t){this._sphericalDelta.theta-=t}_rotateUp(t){this._sphericalDelta.phi-=t}_panLeft(t,e){sn.setFromMatrixColumn(e,0),sn.multiplyScalar(-t),this._panOffset.add(sn)}_panUp(t,e){this.screenSpacePanning===!0?sn.setFromMatrixColumn(e,1):(sn.setFromMatrixColumn(e,0),sn.crossVectors(this.object.up,sn)),sn.multiplyScalar(t),this._panOffset.add(sn)}_pan(t,e){let n=this.domElement;if(this.object.isPerspectiveCamera){let s=this.object.position;sn.copy(s).sub(this.target);let r=sn.length();r*=Math.tan(this.object.fov/2*Math.PI/180),this._panLeft(2*t*r/n.clientHeight,this.object.matrix),this._panUp(2*e*r/n.clientHeight,this.object.matrix)}else this.object.isOrthographicCamera?(this._panLeft(t*(this.object.right-this.object.left)/this.object.zoom/n.clientWidth,this.object.matrix),this._panUp(e*(this.object.top-this.object.bottom)/this.object.zoom/n.clientHeight,this.object.matrix)):(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - pan disabled."),this.enablePan=!1)}_dollyOut(t){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale/=t:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_dollyIn(t){this.object.isPerspectiveCamera||this.object.isOrthographicCamera?this._scale*=t:(console.warn("WARNING: OrbitControls.js encountered an unknown camera type - dolly/zoom disabled."),this.enableZoom=!1)}_updateZoomParameters(t,e){if(!this.zoomToCursor)return;this._performCursorZoom=!0;let n=this.domElement.getBoundingClientRect(),s=t-n.left,r=e-n.top,o=n.width,a=n.height;this._mouse.x=s/o*2-1,this._mouse.y=-(r/a)*2+1,this._dollyDirection.set(this._mouse.x,this._mouse.y,1).unproject(this.object).sub(this.object.position).normalize()}_clampDistance(t){return Math.max(this.minDistance,Math.min(this.maxDistance,t))}_handleMouseDownRotate(t){this._rotateStart.set(t.clientX,t.clientY)}_handleMouseDownDolly(t){this._updateZoomParameters(t.clientX,t.clientX),this._dollyStart.set(t.clientX,t.clientY)}_handleMouseDownPan(t){this._panStart.set(t.clientX,t.clientY)}_handleMouseMoveRotate(t){this._rotateEnd.set(t.clientX,t.clientY),this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let e=this.domElement;this._rotateLeft(kn*this._rotateDelta.x/e.clientHeight),this._rotateUp(kn*this._rotateDelta.y/e.clientHeight),this._rotateStart.copy(this._rotateEnd),this.update()}_handleMouseMoveDolly(t){this._dollyEnd.set(t.clientX,t.clientY),this._dollyDelta.subVectors(this._dollyEnd,this._dollyStart),this._dollyDelta.y>0?this._dollyOut(this._getZoomScale(this._dollyDelta.y)):this._dollyDelta.y<0&&this._dollyIn(this._getZoomScale(this._dollyDelta.y)),this._dollyStart.copy(this._dollyEnd),this.update()}_handleMouseMovePan(t){this._panEnd.set(t.clientX,t.clientY),this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd),this.update()}_handleMouseWheel(t){this._updateZoomParameters(t.clientX,t.clientY),t.deltaY<0?this._dollyIn(this._getZoomScale(t.deltaY)):t.deltaY>0&&this._dollyOut(this._getZoomScale(t.deltaY)),this.update()}_handleKeyDown(t){let e=!1;switch(t.code){case this.keys.UP:t.ctrlKey||t.metaKey||t.shiftKey?this._rotateUp(kn*this.rotateSpeed/this.domElement.clientHeight):this._pan(0,this.keyPanSpeed),e=!0;break;case this.keys.BOTTOM:t.ctrlKey||t.metaKey||t.shiftKey?this._rotateUp(-kn*this.rotateSpeed/this.domElement.clientHeight):this._pan(0,-this.keyPanSpeed),e=!0;break;case this.keys.LEFT:t.ctrlKey||t.metaKey||t.shiftKey?this._rotateLeft(kn*this.rotateSpeed/this.domElement.clientHeight):this._pan(this.keyPanSpeed,0),e=!0;break;case this.keys.RIGHT:t.ctrlKey||t.metaKey||t.shiftKey?this._rotateLeft(-kn*this.rotateSpeed/this.domElement.clientHeight):this._pan(-this.keyPanSpeed,0),e=!0;break}e&&(t.preventDefault(),this.update())}_handleTouchStartRotate(t){if(this._pointers.length===1)this._rotateStart.set(t.pageX,t.pageY);else{let e=this._getSecondPointerPosition(t),n=.5*(t.pageX+e.x),s=.5*(t.pageY+e.y);this._rotateStart.set(n,s)}}_handleTouchStartPan(t){if(this._pointers.length===1)this._panStart.set(t.pageX,t.pageY);else{let e=this._getSecondPointerPosition(t),n=.5*(t.pageX+e.x),s=.5*(t.pageY+e.y);this._panStart.set(n,s)}}_handleTouchStartDolly(t){let e=this._getSecondPointerPosition(t),n=t.pageX-e.x,s=t.pageY-e.y,r=Math.sqrt(n*n+s*s);this._dollyStart.set(0,r)}_handleTouchStartDollyPan(t){this.enableZoom&&this._handleTouchStartDolly(t),this.enablePan&&this._handleTouchStartPan(t)}_handleTouchStartDollyRotate(t){this.enableZoom&&this._handleTouchStartDolly(t),this.enableRotate&&this._handleTouchStartRotate(t)}_handleTouchMoveRotate(t){if(this._pointers.length==1)this._rotateEnd.set(t.pageX,t.pageY);else{let n=this._getSecondPointerPosition(t),s=.5*(t.pageX+n.x),r=.5*(t.pageY+n.y);this._rotateEnd.set(s,r)}this._rotateDelta.subVectors(this._rotateEnd,this._rotateStart).multiplyScalar(this.rotateSpeed);let e=this.domElement;this._rotateLeft(kn*this._rotateDelta.x/e.clientHeight),this._rotateUp(kn*this._rotateDelta.y/e.clientHeight),this._rotateStart.copy(this._rotateEnd)}_handleTouchMovePan(t){if(this._pointers.length===1)this._panEnd.set(t.pageX,t.pageY);else{let e=this._getSecondPointerPosition(t),n=.5*(t.pageX+e.x),s=.5*(t.pageY+e.y);this._panEnd.set(n,s)}this._panDelta.subVectors(this._panEnd,this._panStart).multiplyScalar(this.panSpeed),this._pan(this._panDelta.x,this._panDelta.y),this._panStart.copy(this._panEnd)}_handleTouchMoveDolly(t){let e=this._getSecondPointerPosition(t),n=t.pageX-e.x,s=t.pageY-e.y,r=Math.sqrt(n*n+s*s);this._dollyEnd.set(0,r),this._dollyDelta.set(0,Math.pow(this._dollyEnd.y/this._dollyStart.y,this.zoomSpeed)),this._dollyOut(this._dollyDelta.y),this._dollyStart.copy(this._dollyEnd);let o=(t.pageX+e.x)*.5,a=(t.pageY+e.y)*.5;this._updateZoomParameters(o,a)}_handleTouchMoveDollyPan(t){this.enableZoom&&this._handleTouchMoveDolly(t),this.enablePan&&this._handleTouchMovePan(t)}_handleTouchMoveDollyRotate(t){this.enableZoom&&this._handleTouchMoveDolly(t),this.enableRotate&&this._handleTouchMoveRotate(t)}_addPointer(t){this._pointers.push(t.pointerId)}_removePointer(t){delete this._pointerPositions[t.pointerId];for(let e=0;e<this._pointers.length;e++)if(this._pointers[e]==t.pointerId){this._pointers.splice(e,1);return}}_isTrackingPointer(t){for(let e=0;e<this._pointers.length;e++)if(this._pointers[e]==t.pointerId)return!0;return!1}_trackPointer(t){let e=this._pointerPositions[t.pointerId];e===void 0&&(e=new se,this._pointerPositions[t.pointerId]=e),e.set(t.pageX,t.pageY)}_getSecondPointerPosition(t){let e=t.pointerId===this._pointers[0]?this._pointers[1]:this._pointers[0];return this._pointerPositions[e]}_customWheelEvent(t){let e=t.deltaMode,n={clientX:t.clientX,clientY:t.clientY,deltaY:t.deltaY};switch(e){case 1:n.deltaY*=16;break;case 2:n.deltaY*=100;break}return t.ctrlKey&&!this._controlActive&&(n.deltaY*=10),n}};function Lb(i){this.enabled!==!1&&(this._pointers.length===0&&(this.domElement.setPointerCapture(i.pointerId),this.domElement.addEventListener("pointermove",this._onPointerMove),this.domElement.addEventListener("pointerup",this._onPointerUp)),!this._isTrackingPointer(i)&&(this._addPointer(i),i.pointerType==="touch"?this._onTouchStart(i):this._onMouseDown(i)))}function Db(i){this.enabled!==!1&&(i.pointerType==="touch"?this._onTouchMove(i):this._onMouseMove(i))}function Ub(i){switch(this._removePointer(i),this._pointers.length){case 0:this.domElement.releasePointerCapture(i.pointerId),this.domElement.removeEventListener("pointermove",this._onPointerMove),this.domElement.removeEventListener("pointerup",this._onPointerUp),this.dispatchEvent(km),this.state=Re.NONE;break;case 1:let t=this._pointers[0],e=this._pointerPositions[t];this._onTouchStart({pointerId:t,pageX:e.x,pageY:e.y});break}}function Nb(i){let t;switch(i.button){case 0:t=this.mouseButtons.LEFT;break;case 1:t=this.mouseButtons.MIDDLE;break;case 2:t=this.mouseButtons.RIGHT;break;default:t=-1}switch(t){case er.DOLLY:if(this.enableZoom===!1)return;this._handleMouseDownDolly(i),this.state=Re.DOLLY;break;case er.ROTATE:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=Re.PAN}else{if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=Re.ROTATE}break;case er.PAN:if(i.ctrlKey||i.metaKey||i.shiftKey){if(this.enableRotate===!1)return;this._handleMouseDownRotate(i),this.state=Re.ROTATE}else{if(this.enablePan===!1)return;this._handleMouseDownPan(i),this.state=Re.PAN}break;default:this.state=Re.NONE}this.state!==Re.NONE&&this.dispatchEvent(Ou)}function Ob(i){switch(this.state){case Re.ROTATE:if(this.enableRotate===!1)return;this._handleMouseMoveRotate(i);break;case Re.DOLLY:if(this.enableZoom===!1)return;this._handleMouseMoveDolly(i);break;case Re.PAN:if(this.enablePan===!1)return;this._handleMouseMovePan(i);break}}function Fb(i){this.enabled===!1||this.enableZoom===!1||this.state!==Re.NONE||(i.preventDefault(),this.dispatchEvent(Ou),this._handleMouseWheel(this._customWheelEvent(i)),this.dispatchEvent(km))}function Bb(i){this.enabled===!1||this.enablePan===!1||this._handleKeyDown(i)}function kb(i){switch(this._trackPointer(i),this._pointers.length){case 1:switch(this.touches.ONE){case nr.ROTATE:if(this.enableRotate===!1)return;this._handleTouchStartRotate(i),this.state=Re.TOUCH_ROTATE;break;case nr.PAN:if(this.enablePan===!1)return;this._handleTouchStartPan(i),this.state=Re.TOUCH_PAN;break;default:this.state=Re.NONE}break;case 2:switch(this.touches.TWO){case nr.DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchStartDollyPan(i),this.state=Re.TOUCH_DOLLY_PAN;break;case nr.DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchStartDollyRotate(i),this.state=Re.TOUCH_DOLLY_ROTATE;break;default:this.state=Re.NONE}break;default:this.state=Re.NONE}this.state!==Re.NONE&&this.dispatchEvent(Ou)}function zb(i){switch(this._trackPointer(i),this.state){case Re.TOUCH_ROTATE:if(this.enableRotate===!1)return;this._handleTouchMoveRotate(i),this.update();break;case Re.TOUCH_PAN:if(this.enablePan===!1)return;this._handleTouchMovePan(i),this.update();break;case Re.TOUCH_DOLLY_PAN:if(this.enableZoom===!1&&this.enablePan===!1)return;this._handleTouchMoveDollyPan(i),this.update();break;case Re.TOUCH_DOLLY_ROTATE:if(this.enableZoom===!1&&this.enableRotate===!1)return;this._handleTouchMoveDollyRotate(i),this.update();break;default:this.state=Re.NONE}}function Vb(i){this.enabled!==!1&&i.preventDefault()}function Hb(i){i.key==="Control"&&(this._controlActive=!0,this.domElement.getRootNode().addEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}function Gb(i){i.key==="Control"&&(this._controlActive=!1,this.domElement.getRootNode().removeEventListener("keyup",this._interceptControlUp,{passive:!0,capture:!0}))}var Fu="#ffd34d";function zm(i,t){let e=q("input",{type:"range",class:"grow",min:0,"aria-label":"frame",oninput:()=>li(Ft.trial,+e.value)}),n=q("button",{type:"button",onclick:()=>Is(!Ft.playing,()=>u===Ft.frame)},"play"),s=q("b"),r=q("div",{id:"scene"}),o={pictures:!0,rays:!0,solid:100},a=q("span",{class:"bar",style:"margin:0"});i.append(q("div",{class:"bar"},n,s,e),q("div",{class:"bar"},a,Rs("pictures",!0,d=>{o.pictures=d,m()}),Rs("rays",!0,d=>{o.rays=d,m()}),q("label",{},"solid ",q("input",{type:"range",class:"narrow",min:10,max:100,value:100,oninput:d=>{o.solid=+d.target.value,m()}})),q("span",{class:"soft"},"drag: turn · right: move · wheel: nearer")),r);let l=null,c=null,u=-1,f=0,h=-1;async function p(){let d=new dl({antialias:!0,preserveDrawingBuffer:!0});d.setPixelRatio(window.devicePixelRatio||1),r.replaceChildren(d.domElement);let S=new pl;S.background=new pe(getComputedStyle(document.documentElement).getPropertyValue("--screen").trim()),S.add(new Sl(16777215,1.1));let v=new An(35,1,1,2e4),y=new Ml(16777215,2.2);v.add(y),y.position.set(.4,.6,1),S.add(v);let I=new Cl(v,d.domElement),C=()=>d.render(S,v);I.addEventListener("change",C),l={renderer:d,scene:S,camera:v,controls:I,render:C,meshes:await mr(),trial:null},new ResizeObserver(()=>{let{clientWidth:R,clientHeight:L}=r;!R||!L||(d.setSize(R,L),v.aspect=R/L,v.updateProjectionMatrix(),C())}).observe(r)}function _(){h=Ft.trial;let d=gt.trials[Ft.trial];e.max=d.frames.length-1,l.trial&&l.scene.remove(l.trial.group);let S=new Ji,v=d.rows.flatMap((R,L)=>R.poses.map(E=>E&&as(E,gt.bodies[d.bodies[L]].centroid??[0,0,0]).at)).filter(Boolean),y=Ve(v.reduce(hn,[0,0,0]),1/Math.max(1,v.length)),I=d.bodies.map((R,L)=>{let E=l.meshes.get(R);if(!E)return null;let b=new Bn;b.setAttribute("position",new pn(new Float32Array(E.xyz),3)),b.setIndex(new pn(E.triangles,1)),b.computeVertexNormals();let A=new Cn(b,new Go({color:d.colours[L],roughness:.6,metalness:.05,side:ii}));return S.add(A),A}),C=d.views.map(R=>Wb(gt.views[R],y,v,S));a.replaceChildren(...gt.trials[Ft.trial].views.map((R,L)=>q("button",{type:"button",onclick:()=>g(L)},`from ${gt.views[R].name}`)),q("button",{type:"button",onclick:()=>g(-1)},"overview")),l.scene.add(S),l.trial={group:S,bodies:I,views:C,centre:y},g(-1)}function g(d){let{camera:S,controls:v,trial:y}=l,I=Ve(y.views[0].down,-1),C=y.centre,R;if(d>=0){R=y.views[d].view.source,S.up.set(...Ve(y.views[d].down,-1));let L=ai(Hn(R,C));S.fov=Math.min(60,2*Math.atan(y.views[d].half/y.views[d].depth)*180/Math.PI),S.position.set(...hn(C,Ve(Gn(Hn(R,C)),L)))}else{let L=y.views.map(({view:A})=>Gn(Hn(A.source,C))).reduce(hn,[0,0,0]),E=Math.max(...y.views.map(({view:A,corners:O})=>Math.max(ai(Hn(A.source,C)),...O.map(F=>ai(Hn(F,C))))));S.up.set(...I),S.fov=35;let b=y.views.length>1?L:hn(L,y.views[0].right);S.position.set(...hn(C,Ve(Gn(hn(Gn(b),Ve(I,.55))),1.95*E)))}v.target.set(...C),S.near=1,S.far=5e4,S.updateProjectionMatrix(),v.update(),l.render()}async function m(){if(n.textContent=Ft.playing?"pause":"play",!t())return;let d=++f;try{if(await(c??=p()),d!==f)return;h!==Ft.trial&&_();let{trial:S,frame:v}=Ft,y=gt.trials[S];e.value=v,s.textContent=`${y.name} · ${y.frames[v]}`;let I=o.pictures?await ls(S,v).catch(()=>null):null;if(d!==f)return;l.trial.bodies.forEach((C,R)=>{if(!C)return;let L=y.rows[R].poses[v];if(C.visible=!!L,!L)return;let{q:E,at:b}=as(L,l.meshes.get(y.bodies[R]).centroid);C.position.set(...b),C.quaternion.set(E[1],E[2],E[3],E[0]);let A=oa(S,R,v)==="f";Object.assign(C.material,{opacity:o.solid/100,transparent:o.solid<100,wireframe:A})}),l.trial.views.forEach((C,R)=>{let L=I?.views.find(E=>E.slot===R);C.plane.visible=o.pictures&&!!L,L&&(C.texture.image=L.image,C.texture.needsUpdate=!0),C.rays.visible=o.rays}),l.render(),u=v,v+1<y.frames.length&&ls(S,v+1).catch(()=>{})}catch(S){l||(c=null),r.replaceChildren(q("p",{class:"note"},`The 3D view cannot be shown: ${S.message}`))}}return Ci(m),{show:m,drawn:()=>u,world:()=>l}}function Wb(i,t,e,n){let s=Math.max(...[...e,t].map(I=>xo(i,I)[2])),r=i.detector_mm??1.35*s,[o,a]=i.size,l=(I,C)=>Hl(i,[I,C],r),c=[l(-.5,-.5),l(o-.5,-.5),l(o-.5,a-.5),l(-.5,a-.5)],u=new Cn(new xl(.012*r,20,12),new Go({color:Fu,emissive:Fu,emissiveIntensity:.5}));u.position.set(...i.source);let f=(I,C)=>new _l(new Bn().setFromPoints(I.map(R=>new Y(...R))),new io({color:C})),h=new Ji;h.add(f(c.flatMap(I=>[i.source,I]),"#6d6a4a"),f([i.source,l((o-1)/2,(a-1)/2)],Fu)),n.add(u,h,new Ho(new Bn().setFromPoints([...c,c[0]].map(I=>new Y(...I))),new io({color:"#8d97a5"})));let p=i.recorded?24:1,[_,g,m]=[[],[],[]];for(let I=0;I<=p;I++)for(let C=0;C<=p;C++){let[R,L]=[C/p*o-.5,I/p*a-.5];_.push(...l(R,L));let[E,b]=ea(i,R,L);if(g.push((E+.5)/o,1-(b+.5)/a),C<p&&I<p){let A=I*(p+1)+C;m.push(A,A+1,A+p+1,A+1,A+p+2,A+p+1)}}let d=new Bn;d.setAttribute("position",new pn(new Float32Array(_),3)),d.setAttribute("uv",new pn(new Float32Array(g),2)),d.setIndex(m);let S=new Fn;S.colorSpace=Un;let v=new Cn(d,new eo({map:S,side:ii}));v.visible=!1,n.add(v);let y=Hl(i,[o/2,a/2],r);return{view:i,corners:c,plane:v,texture:S,rays:h,depth:r,half:ai(Hn(l(o/2,0),y)),down:Gn(wn(i.inverse,[0,1,0])),right:Gn(wn(i.inverse,[1,0,0]))}}var Vm={overview:"Overview",frame:"Frames",kinematics:"Kinematics",space:"3D",review:"Review",calibration:"Calibration",slices:"Slices",models:"Models",methods:"Methods"},Hm=[...document.querySelectorAll("section.tab")],Gm=document.querySelector("nav");Gm.append(...Hm.map(i=>q("a",{href:`#${i.id}`},Vm[i.id])));var Ui="overview",Rl=i=>()=>Ui===i,qo=i=>document.getElementById(i);xf();var Pl={frame:jd(qo("frame"),Rl("frame")),kinematics:tp(qo("kinematics"),Rl("kinematics")),space:zm(qo("space"),Rl("space")),review:sp(qo("review"),Rl("review"))};function Bu(){let[i,t,e]=location.hash.slice(1).split("/").map(decodeURIComponent);if(i==="selftest")return;let n=Ui;Ui=Vm[i]&&qo(i)?i:"overview";for(let s of Hm)s.hidden=s.id!==Ui;for(let s of Gm.children)s.toggleAttribute("aria-current",s.hash===`#${Ui}`);if(Ui==="frame"){let s=gt.trials.findIndex(o=>o.name===t),r=s<0?-1:gt.trials[s].frames.indexOf(e);r>=0&&li(s,r)}n!==Ui&&(Is(!1),scrollTo(0,0)),Pl[Ui]?.show()}addEventListener("hashchange",Bu);document.addEventListener("keydown",i=>{if(/^(TEXTAREA|SELECT)$/.test(i.target.tagName)||i.target.tagName==="INPUT"&&i.target.type!=="range"||i.ctrlKey||i.metaKey||i.altKey||!["frame","space","kinematics"].includes(Ui))return;let e={ArrowLeft:-1,ArrowRight:1}[i.key];if(e)li(Ft.trial,Ft.frame+e);else if(i.key===" "&&i.target.tagName!=="BUTTON")Is(!Ft.playing,()=>Ui==="space"?Pl.space.drawn()===Ft.frame:Pl.frame.ready());else return;i.preventDefault()});document.getElementById("copy-methods").addEventListener("click",async i=>{let t=document.getElementById("methods-text");try{await navigator.clipboard.writeText(t.textContent)}catch{getSelection().selectAllChildren(t),document.execCommand("copy")}i.target.textContent="Copied"});Bu();location.hash==="#selftest"&&rp(Pl,i=>{location.hash=i,Bu()});})();
